#include "tests/experiments/line_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "tests/experiments/report.hpp"

namespace flogmap::experiments {
namespace {

constexpr double kWidth = 640, kHeight = 360, kLeft = 64, kRight = 16, kTop = 36, kBottom = 48;
constexpr std::array<const char*, 6> kColours{"#0072b2", "#d55e00", "#009e73",
                                              "#cc79a7", "#e69f00", "#56b4e9"};

/// One axis: what it shows and where that lies on the paper.
struct Axis {
  double low = 0, high = 1, step = 1;
  double paper_low = 0, paper_high = 1;

  [[nodiscard]] double at(double value) const {
    return paper_low + (value - low) / (high - low) * (paper_high - paper_low);
  }
  [[nodiscard]] int decimals() const { return std::max(0, static_cast<int>(-std::floor(std::log10(step)))); }
};

/// Rounded outwards to steps of 1, 2 or 5 times a power of ten.
Axis axis_over(double low, double high, double paper_low, double paper_high) {
  if (!(high > low)) high = low + 1;
  const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double nice : {5.0, 2.0, 1.0}) {
    if (nice * power >= rough) step = nice * power;
  }
  return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, step, paper_low,
          paper_high};
}

std::string label(double x, double y, const std::string& anchor, const std::string& words,
                  const std::string& more = "") {
  return "<text x=\"" + text(x, 1) + "\" y=\"" + text(y, 1) + "\" text-anchor=\"" + anchor + "\"" + more +
         ">" + words + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& colour) {
  return "<line x1=\"" + text(x1, 1) + "\" y1=\"" + text(y1, 1) + "\" x2=\"" + text(x2, 1) + "\" y2=\"" +
         text(y2, 1) + "\" stroke=\"" + colour + "\"/>\n";
}

std::string grid_of(const Axis& x, const Axis& y) {
  std::string svg;
  for (double v = y.low; v <= y.high + y.step / 2; v += y.step) {
    svg += line(x.paper_low, y.at(v), x.paper_high, y.at(v), "#ddd");
    svg += label(x.paper_low - 6, y.at(v) + 4, "end", text(v, y.decimals()));
  }
  for (double v = x.low; v <= x.high + x.step / 2; v += x.step) {
    svg += line(x.at(v), y.paper_low, x.at(v), y.paper_low + 4, "#333");
    svg += label(x.at(v), y.paper_low + 18, "middle", text(v, x.decimals()));
  }
  return svg + line(x.paper_low, y.paper_low, x.paper_high, y.paper_low, "#333");
}

std::string curve(const Series& series, const Axis& x, const Axis& y, const std::string& colour) {
  std::string points, dots;
  for (const Eigen::Vector2d& p : series.points) {
    const std::string px = text(x.at(p.x()), 1), py = text(y.at(p.y()), 1);
    points += px + "," + py + " ";
    dots += "<circle cx=\"" + px + "\" cy=\"" + py + "\" r=\"2.5\" fill=\"" + colour + "\"/>";
  }
  const std::string path =
      "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" + colour + "\" points=\"" + points + "\"/>\n";
  return path + (series.points.size() <= 24 ? dots + "\n" : "");
}

std::string legend(const std::vector<Series>& series) {
  std::string svg;
  double y = kTop + 8;
  for (std::size_t i = 0; i < series.size(); ++i, y += 16) {
    const std::string colour = kColours[i % kColours.size()];
    svg += label(kWidth - kRight - 4, y + 4, "end", series[i].name, " fill=\"" + colour + "\"");
  }
  return svg;
}

}  // namespace

void write_chart(const std::filesystem::path& file, const LineChart& chart) {
  Eigen::AlignedBox2d box;
  for (const Series& series : chart.series) {
    for (const Eigen::Vector2d& p : series.points) box.extend(p);
  }
  if (chart.from_zero) box.extend(Eigen::Vector2d(box.min().x(), 0));
  const Axis x = axis_over(box.min().x(), box.max().x(), kLeft, kWidth - kRight);
  const Axis y = axis_over(box.min().y(), box.max().y(), kHeight - kBottom, kTop);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 360\" width=\"640\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"640\" height=\"360\" fill=\"#fff\"/>\n";
  svg += label(kLeft, 20, "start", chart.title, " font-weight=\"bold\"") + grid_of(x, y);
  svg += label((kLeft + kWidth) / 2, kHeight - 10, "middle", chart.x_label);
  svg += label(14, kHeight / 2, "middle", chart.y_label, " transform=\"rotate(-90 14 180)\"");
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    svg += curve(chart.series[i], x, y, kColours[i % kColours.size()]);
  }
  std::ofstream out(file);
  out << svg << legend(chart.series) << "</svg>\n" << std::flush;
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace flogmap::experiments
