#include "server/export/path_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "mapping/flog/map_picture.hpp"
#include "mapping/flog/map_planes.hpp"
#include "server/export/exported_file.hpp"
#include "server/export/picture_area.hpp"

namespace flogmap {
namespace {

constexpr int kWantedPx = 1400;                // the longer side, if the map is small
constexpr double kMarginM = 0.25;              // around what was seen
constexpr float kFigureConfidence = 1.0F / 8;  // of N_K
constexpr double kTickEveryM = 0.5;            // along the path
constexpr double kTickPx = 13;
constexpr double kMaxPathCells = 5000;  // from the origin; a path that strays farther is cut off
constexpr int kLegendPx = 64;
constexpr int kLegendWidthPx = 900;  // below that the words do not fit

const cv::Vec3b kPaper{216, 210, 204};  // never seen; blue, green, red
const cv::Vec3b kFree{255, 255, 255};
const cv::Scalar kPathColour{200, 90, 20};
const cv::Scalar kTickColour{60, 160, 240};
const cv::Scalar kStartColour{60, 160, 30};
const cv::Scalar kEndColour{40, 40, 210};
const cv::Scalar kInk{40, 40, 40};

/// A piece of paper for the map, and where things lie on it.
struct Sheet {
  MapArea area;
  double cell_size_m = 0;
  int factor = 1;  // pixels along a cell
  cv::Mat pixels;

  [[nodiscard]] cv::Point2d px(double x_m, double y_m) const {
    const double column = x_m / cell_size_m - area.low.x;
    const double row = area.high.y - y_m / cell_size_m;
    return {column * factor, row * factor};
  }
};

bool has_pose(const TrajectoryEntry& entry) {
  return entry.state == TrackingState::ok || entry.state == TrackingState::weak;
}

/// What was seen and where the camera was, as far as a picture of it makes sense.
MapArea area_of(const MapSnapshot& map, const std::vector<TrajectoryEntry>& trajectory) {
  const double a = map.info.grid.cell_size_m;
  MapArea area = picture_area(map);
  for (const TrajectoryEntry& entry : trajectory) {
    const Eigen::Vector3d at = entry.world_from_camera.translation() / a;
    if (!has_pose(entry) || at.head<2>().cwiseAbs().maxCoeff() > kMaxPathCells) continue;
    const CellIndex cell{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))};
    area.low = {std::min(area.low.x, cell.x), std::min(area.low.y, cell.y)};
    area.high = {std::max(area.high.x, cell.x + 1), std::max(area.high.y, cell.y + 1)};
  }
  const int margin = static_cast<int>(std::ceil(kMarginM / a));
  return {{area.low.x - margin, area.low.y - margin}, {area.high.x + margin, area.high.y + margin}};
}

/// The same cells, trusted sooner: in a short recording few cells reach full confidence, and a figure as pale
/// as that could not be read. What only a few rays tell stays pale.
MapSnapshot trusted_sooner(MapSnapshot map) {
  for (float& N_K : map.info.full_confidence_rays) N_K = std::max(1.0F, N_K * kFigureConfidence);
  return map;
}

/// Columns that were seen in any layer.
Image<std::uint8_t> seen_mask(const MapSnapshot& map, const MapArea& area) {
  Image<std::uint8_t> seen(static_cast<int>(area.width()), static_cast<int>(area.height()));
  for (int k = 0; k < map.info.grid.num_layers(); ++k) {
    const Image<std::uint8_t> layer = trinary_picture(map, area, k, {}).grey;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (layer.pixels[i] != kTrinaryUnknown) seen.pixels[i] = 1;
    }
  }
  return seen;
}

Sheet draw_map(const StoredMap& stored, Operators operators) {
  const MapSnapshot map = snapshot_of(stored);
  Rules rules;
  rules.operators = operators;
  const MapPicture picture = map_picture(trusted_sooner(map), area_of(map, stored.trajectory), {}, rules);
  const Image<std::uint8_t> seen = seen_mask(map, picture.area);
  cv::Mat cells(seen.height, seen.width, CV_8UC3);
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      const cv::Vec3b base = seen.at(x, y) != 0 ? kFree : kPaper;
      cells.at<cv::Vec3b>(y, x) = base * (picture.grey.at(x, y) / 255.0);
    }
  }
  const int factor = std::clamp(kWantedPx / std::max(seen.width, seen.height), 1, 16);
  Sheet sheet{picture.area, picture.cell_size_m, factor, {}};
  cv::resize(cells, sheet.pixels, {}, factor, factor, cv::INTER_NEAREST);
  return sheet;
}

cv::Point2d place(const Sheet& sheet, const TrajectoryEntry& entry) {
  const Eigen::Vector3d p = entry.world_from_camera.translation();
  return sheet.px(p.x(), p.y());
}

/// OpenCV draws at integers; a shift keeps the lines smooth.
cv::Point fine(cv::Point2d p) {
  return {static_cast<int>(std::lround(p.x * 16)), static_cast<int>(std::lround(p.y * 16))};
}

void draw_line(cv::Mat& pixels, cv::Point2d a, cv::Point2d b, const cv::Scalar& colour, int width_px) {
  cv::line(pixels, fine(a), fine(b), colour, width_px, cv::LINE_AA, 4);
}

/// Where the camera looks, seen from above; nothing much if it looks straight up or down.
void draw_heading(Sheet& sheet, const TrajectoryEntry& entry) {
  const Eigen::Vector3d forward = entry.world_from_camera.linear().col(2);
  const cv::Point2d at = place(sheet, entry);
  draw_line(sheet.pixels, at, {at.x + kTickPx * forward.x(), at.y - kTickPx * forward.y()}, kTickColour, 2);
}

/// Calls draw(from, to) for every step between two frames that follow one another with a pose.
template <typename Draw>
void for_each_step(const std::vector<TrajectoryEntry>& trajectory, const Draw& draw) {
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    if (has_pose(trajectory[i - 1]) && has_pose(trajectory[i])) draw(trajectory[i - 1], trajectory[i]);
  }
}

void draw_path(Sheet& sheet, const std::vector<TrajectoryEntry>& trajectory) {
  double since_tick_m = kTickEveryM;
  for_each_step(trajectory, [&](const TrajectoryEntry& from, const TrajectoryEntry& to) {
    since_tick_m += (to.world_from_camera.translation() - from.world_from_camera.translation()).norm();
    if (since_tick_m < kTickEveryM) return;
    since_tick_m = 0;
    draw_heading(sheet, to);
  });
  for_each_step(trajectory, [&](const TrajectoryEntry& from, const TrajectoryEntry& to) {
    draw_line(sheet.pixels, place(sheet, from), place(sheet, to), kPathColour, 2);
  });
}

void draw_start(cv::Mat& pixels, cv::Point2d at) {
  cv::circle(pixels, fine(at), 7 * 16, {255, 255, 255}, cv::FILLED, cv::LINE_AA, 4);
  cv::circle(pixels, fine(at), 5 * 16, kStartColour, cv::FILLED, cv::LINE_AA, 4);
}

void draw_end(cv::Mat& pixels, cv::Point2d at) {
  const cv::Point2d outer(6, 6), inner(4, 4);
  cv::rectangle(pixels, cv::Point(at - outer), cv::Point(at + outer), {255, 255, 255}, cv::FILLED);
  cv::rectangle(pixels, cv::Point(at - inner), cv::Point(at + inner), kEndColour, cv::FILLED);
}

void draw_ends(Sheet& sheet, const std::vector<TrajectoryEntry>& trajectory) {
  const auto first = std::ranges::find_if(trajectory, has_pose);
  if (first == trajectory.end()) return;
  const auto last = std::find_if(trajectory.rbegin(), trajectory.rend(), has_pose);
  draw_start(sheet.pixels, place(sheet, *first));
  draw_end(sheet.pixels, place(sheet, *last));
}

void write(cv::Mat& pixels, const std::string& text, int x, int y) {
  cv::putText(pixels, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
}

/// A small square of a colour and what it means; returns where the next may begin.
int draw_key(cv::Mat& pixels, const cv::Scalar& colour, const std::string& text, int x, int y) {
  cv::rectangle(pixels, {x, y - 10}, {x + 12, y + 2}, colour, cv::FILLED);
  cv::rectangle(pixels, {x, y - 10}, {x + 12, y + 2}, kInk, 1);
  write(pixels, text, x + 18, y);
  return x + 18 + cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.45, 1, nullptr).width + 22;
}

/// The longest of 1, 2, 5, 10 ... metres that takes at most a fifth of the width; at least 0.1 m.
double scale_bar_m(double width_m) {
  double best = 0.1;
  for (const double length_m : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0}) {
    if (length_m <= width_m / 5) best = length_m;
  }
  return best;
}

cv::Mat draw_legend(const Sheet& sheet, int width_px) {
  cv::Mat legend(kLegendPx, width_px, CV_8UC3, cv::Scalar(255, 255, 255));
  const double bar_m = scale_bar_m(static_cast<double>(sheet.area.width()) * sheet.cell_size_m);
  const int bar_px = static_cast<int>(std::lround(bar_m / sheet.cell_size_m * sheet.factor));
  cv::rectangle(legend, {12, 14}, {12 + bar_px, 19}, kInk, cv::FILLED);
  write(legend, shortest_text(bar_m) + " m", 12 + bar_px + 8, 21);
  int x = 12;
  const int y = 50;
  x = draw_key(legend, {0, 0, 0}, "occupied (darker = surer)", x, y);
  x = draw_key(legend, kFree, "free", x, y);
  x = draw_key(legend, kPaper, "never seen", x, y);
  x = draw_key(legend, kPathColour, "camera path", x, y);
  x = draw_key(legend, kTickColour, "looking", x, y);
  x = draw_key(legend, kStartColour, "start", x, y);
  draw_key(legend, kEndColour, "end", x, y);
  return legend;
}

Image<Rgb> image_of(const cv::Mat& pixels) {
  Image<Rgb> image(pixels.cols, pixels.rows);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto& p = pixels.at<cv::Vec3b>(y, x);
      image.at(x, y) = {p[2], p[1], p[0]};
    }
  }
  return image;
}

}  // namespace

Image<Rgb> path_picture(const StoredMap& map, Operators operators) {
  Sheet sheet = draw_map(map, operators);
  draw_path(sheet, map.trajectory);
  draw_ends(sheet, map.trajectory);
  const int width_px = std::max(sheet.pixels.cols, kLegendWidthPx);
  cv::Mat all(sheet.pixels.rows + kLegendPx, width_px, CV_8UC3, cv::Scalar(kPaper));
  sheet.pixels.copyTo(all(cv::Rect(0, 0, sheet.pixels.cols, sheet.pixels.rows)));
  draw_legend(sheet, width_px).copyTo(all(cv::Rect(0, sheet.pixels.rows, width_px, kLegendPx)));
  return image_of(all);
}

}  // namespace flogmap
