#include "camera/simulation/patterns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "camera/simulation/noise.hpp"

namespace flogmap {
namespace {

double unit(double tone) { return std::clamp(tone, 0.0, 1.0); }

double fraction(double x) { return x - floor_of(x); }

/// 1 inside [low, high], falling to 0 within `edge` outside it.
double band(double x, double low, double high, double edge = 0.002) {
  return smooth_step(low - edge, low, x) * (1 - smooth_step(high, high + edge, x));
}

double box_band(const PatternPoint& p, double u0, double v0, double u1, double v1) {
  return band(p.u, u0, u1) * band(p.v, v0, v1);
}

/// Lines of something like print in the rectangle: words as dark dashes.
double print(const PatternPoint& p, double u0, double v0, double u1, double v1, double line_m) {
  const double line = floor_of((p.v - v0) / line_m);
  const double word = cell_noise((p.u - u0) / (1.3 * line_m), line, p.seed + 91);
  const double ink = band(fraction((p.v - v0) / line_m), 0.25, 0.7, 0.1) * (word > 0.28 ? 1.0 : 0.0);
  return ink * box_band(p, u0, v0, u1, v1);
}

double grain(double along, double across, std::uint32_t seed) {
  const double bend = 0.02 * value_noise(along * 1.5, across * 6, seed + 5);
  const double fibres = cloud_noise(along * 3, (across + bend) * 90, 3, seed);
  const double rings =
      0.5 + 0.5 * std::sin((across + 4 * bend) * 160 + 9 * value_noise(along, across * 4, seed + 9));
  return 0.7 * fibres + 0.3 * rings;
}

double planks(const PatternPoint& p) {
  const double row = floor_of(p.v / p.size);
  const double length = 9 * p.size;
  const double along = p.u + length * cell_noise(row, 3, p.seed);
  const double column = floor_of(along / length);
  const double tone = cell_noise(row, column, p.seed + 1);
  const auto plank = mixed(static_cast<std::uint32_t>(static_cast<int>(row)),
                           static_cast<std::uint32_t>(static_cast<int>(column)), p.seed);
  const double from_edge = p.size * std::min(fraction(p.v / p.size), 1 - fraction(p.v / p.size));
  const double from_end = length * std::min(fraction(along / length), 1 - fraction(along / length));
  const double gap = smooth_step(0.0008, 0.004, std::min(from_edge, from_end));
  return unit((0.2 + 0.4 * tone + 0.65 * (grain(along, p.v, plank) - 0.35)) * (0.25 + 0.75 * gap));
}

double wood(const PatternPoint& p) {
  const bool upright = p.height > p.width;
  return unit(grain(upright ? p.v : p.u, upright ? p.u : p.v, p.seed) * 1.3 - 0.15);
}

double bricks(const PatternPoint& p) {
  const double height = p.size / 3;
  const double row = floor_of(p.v / height);
  const double along = p.u / p.size + 0.5 * fraction(row / 2) * 2;
  const double tone = cell_noise(floor_of(along), row, p.seed + 2);
  const double wobble = 0.006 * (value_noise(p.u * 40, p.v * 40, p.seed) - 0.5);
  const double from_side = p.size * std::min(fraction(along), 1 - fraction(along)) + wobble;
  const double from_bed = height * std::min(fraction(p.v / height), 1 - fraction(p.v / height)) + wobble;
  const double brick = smooth_step(0.004, 0.008, std::min(from_side, from_bed));
  const double rough = cloud_noise(p.u * 45, p.v * 45, 3, p.seed + 4) - 0.5;
  const double stain = cloud_noise(p.u * 2.2, p.v * 2.2, 3, p.seed + 8) - 0.5;
  return unit(brick * (0.1 + 0.5 * tone + 0.6 * rough) + (1 - brick) * (0.85 + 0.3 * rough) + 0.3 * stain);
}

double plaster(const PatternPoint& p) {
  const double stains = cloud_noise(p.u * 2.3, p.v * 2.3, 3, p.seed) - 0.5;
  const double strokes = cloud_noise(p.u * 14 + 3 * stains, p.v * 26, 3, p.seed + 7) - 0.5;
  const double pores = value_noise(p.u * 130, p.v * 130, p.seed + 11) - 0.5;
  return unit(0.5 + 0.7 * stains + 0.75 * strokes + 0.35 * pores);
}

double wallpaper(const PatternPoint& p) {
  const double s = 2 * std::numbers::pi / p.size;
  const double sway = 0.35 * std::sin(p.v * s);
  const double stem = std::cos(p.u * s + 3 * sway) + 0.6 * std::cos(2 * p.v * s + p.u * s) +
                      0.4 * std::cos(3 * p.u * s - 2 * p.v * s);
  const double leaves = smooth_step(0.1, 0.45, stem);
  const double wear = cloud_noise(p.u * 3, p.v * 3, 4, p.seed) - 0.5;
  const double paper = cloud_noise(p.u * 70, p.v * 70, 2, p.seed + 3) - 0.5;
  return unit(0.3 + 0.42 * leaves + 0.6 * wear + 0.4 * paper);
}

double fabric(const PatternPoint& p) {
  const double weave =
      std::sin(p.u * 700 + 2 * value_noise(p.u * 60, p.v * 60, p.seed)) * std::sin(p.v * 700);
  const double check =
      std::max(band(fraction(p.u / p.size), 0.0, 0.18, 0.02), band(fraction(p.v / p.size), 0.0, 0.18, 0.02));
  const double yarn = cloud_noise(p.u * 55, p.v * 55, 3, p.seed + 1) - 0.5;
  const double worn = cloud_noise(p.u * 5, p.v * 5, 3, p.seed + 5) - 0.5;
  return unit(0.45 + 0.08 * weave + 0.25 * check + 0.7 * yarn + 0.4 * worn);
}

double carpet(const PatternPoint& p) {
  const double pile = cloud_noise(p.u * 90, p.v * 90, 2, p.seed) - 0.5;
  const double tufts = cloud_noise(p.u * 22, p.v * 22, 3, p.seed + 3) - 0.5;
  const double trodden = cloud_noise(p.u * 1.7, p.v * 1.7, 3, p.seed + 6) - 0.5;
  return unit(0.5 + 0.7 * pile + 0.5 * tufts + 0.4 * trodden);
}

/// A woven rug: borders, and a field of stepped diamonds.
double rug(const PatternPoint& p) {
  const double from_edge = std::min({p.u, p.v, p.width - p.u, p.height - p.v});
  const double step = 0.012;
  const double x = std::abs(fraction(floor_of(p.u / step) * step / p.size) - 0.5);
  const double y = std::abs(fraction(floor_of(p.v / step) * step / p.size) - 0.5);
  const double diamond = x + y;
  double tone = 0.32 + 0.38 * band(diamond, 0.2, 0.3, 0.01) + 0.3 * band(diamond, -1, 0.1, 0.01);
  tone += 0.25 * (cell_noise(p.u / p.size, p.v / p.size, p.seed) - 0.5);
  if (from_edge < 0.22) tone = 0.22 + 0.5 * band(fraction(p.u / 0.09 + p.v / 0.09), 0.0, 0.45, 0.03);
  if (from_edge < 0.1) tone = 0.75;
  if (from_edge < 0.06) tone = 0.15;
  const double yarn = cloud_noise(p.u * 110, p.v * 60, 2, p.seed + 2) - 0.5;
  const double faded = cloud_noise(p.u * 3, p.v * 3, 3, p.seed + 4) - 0.5;
  return unit(tone + 0.5 * yarn + 0.3 * faded);
}

double cardboard(const PatternPoint& p) {
  const double fibres = cloud_noise(p.u * 25, p.v * 80, 3, p.seed) - 0.5;
  const double dents = cloud_noise(p.u * 7, p.v * 7, 3, p.seed + 1) - 0.5;
  double tone = 0.55 + 0.5 * fibres + 0.4 * dents;
  tone += 0.3 * band(p.v, 0.5 * p.height - 0.025, 0.5 * p.height + 0.025);  // tape
  const double left = p.width * (0.12 + 0.3 * cell_noise(1, 1, p.seed)), low = p.height * 0.12;
  const double label = box_band(p, left, low, left + 0.4 * p.width, low + 0.28 * p.height);
  tone = tone * (1 - label) + 0.95 * label;
  tone -= 0.85 *
          print(p, left + 0.02, low + 0.02, left + 0.4 * p.width - 0.02, low + 0.28 * p.height - 0.02, 0.018);
  tone -= 0.55 * print(p, 0.55 * p.width, 0.66 * p.height, 0.93 * p.width, 0.9 * p.height, 0.05);
  return unit(tone);
}

/// Spines of books side by side, of different heights, with titles.
double books(const PatternPoint& p) {
  constexpr double kPitch = 0.034;
  const auto boundary = [&](double i) { return (i + 0.55 * (cell_noise(i, 7, p.seed) - 0.5)) * kPitch; };
  double book = floor_of(p.u / kPitch);
  if (p.u < boundary(book)) book -= 1;
  if (p.u >= boundary(book + 1)) book += 1;
  const double left = boundary(book), right = boundary(book + 1);
  const double tall = p.height * (0.72 + 0.26 * cell_noise(book, 2, p.seed));
  if (p.v > tall) return 0.04 + 0.1 * value_noise(p.u * 40, p.v * 40, p.seed);
  const double across = (p.u - left) / (right - left);
  const double round = 0.55 + 0.45 * std::sin(std::numbers::pi * unit(across));
  double tone = 0.15 + 0.75 * cell_noise(book, 1, p.seed);
  const double ink = tone > 0.5 ? -0.5 : 0.5;
  const double title = 0.35 + 0.3 * cell_noise(book, 4, p.seed);
  tone += ink * band(p.v, title * tall, (title + 0.25) * tall) * band(across, 0.3, 0.7, 0.05) *
          (value_noise(p.u * 160, p.v * 160, p.seed + 3) > 0.4 ? 1 : 0.2);
  tone += 0.7 * ink * (band(p.v, 0.08 * tall, 0.1 * tall) + band(p.v, 0.9 * tall, 0.92 * tall));
  return unit((tone + 0.2 * (value_noise(p.u * 90, p.v * 30, p.seed) - 0.5)) * round);
}

/// A framed print: shapes on a ground, a white margin, a caption.
double poster(const PatternPoint& p) {
  const double from_edge = std::min({p.u, p.v, p.width - p.u, p.height - p.v});
  const double paper = 0.12 * (cloud_noise(p.u * 60, p.v * 60, 2, p.seed + 2) - 0.5);
  if (from_edge < 0.02) return unit(0.08 + paper);
  if (from_edge < 0.05) return unit(0.92 + paper);
  const double x = p.u / p.width, y = p.v / p.height;
  double tone = 0.35 + 0.4 * y + 0.5 * (cloud_noise(p.u * 9, p.v * 9, 4, p.seed) - 0.5);
  for (int i = 0; i < 9; ++i) {
    const double cx = cell_noise(i, 11, p.seed), cy = 0.2 + 0.75 * cell_noise(i, 12, p.seed);
    const double r = 0.05 + 0.16 * cell_noise(i, 13, p.seed);
    const double distance =
        i % 3 == 0 ? std::max(std::abs(x - cx), std::abs(y - cy)) : std::hypot(x - cx, y - cy);
    const double inside = 1 - smooth_step(r - 0.006, r, distance);
    tone =
        tone * (1 - inside) + inside * (cell_noise(i, 14, p.seed) + 0.15 * std::sin(90 * (x + y * (i % 2))));
  }
  if (y < 0.16) tone = 0.9 - 0.85 * print(p, 0.08, 0.07, p.width - 0.08, 0.16 * p.height, 0.022);
  return unit(tone + paper);
}

/// Sky and trees behind a window's bars.
double window(const PatternPoint& p) {
  const double from_edge = std::min({p.u, p.v, p.width - p.u, p.height - p.v});
  const double bar = std::max(band(p.u, p.width / 2 - 0.025, p.width / 2 + 0.025),
                              band(p.v, 0.62 * p.height - 0.02, 0.62 * p.height + 0.02));
  const double frame = 0.75 + 0.4 * (cloud_noise(p.u * 40, p.v * 40, 3, p.seed) - 0.5);
  if (from_edge < 0.06 || bar > 0.5) return unit(frame - 0.3 * band(from_edge, 0.052, 0.06));
  const double y = p.v / p.height;
  const double horizon = 0.32 + 0.5 * (cloud_noise(p.u * 3.5, 0, 4, p.seed + 1) - 0.5);
  const double leaves = cloud_noise(p.u * 24, p.v * 24, 4, p.seed + 2);
  const double clouds = 0.8 + 0.5 * (cloud_noise(p.u * 2.5, p.v * 5, 4, p.seed + 3) - 0.4);
  return unit(y < horizon ? 0.6 * leaves : clouds);
}

double door(const PatternPoint& p) {
  const double x = p.u / p.width, y = p.v / p.height;
  double tone = 0.35 + 0.8 * (grain(p.v, p.u, p.seed) - 0.3);
  for (const auto& [low, high] : {std::pair(0.08, 0.42), std::pair(0.5, 0.92)}) {
    const double inset = std::min({x - 0.16, 0.84 - x, (y - low) * 2, (high - y) * 2});
    tone += -0.3 * band(inset, 0.0, 0.015, 0.004) + 0.2 * band(inset, 0.03, 0.05, 0.004);
  }
  const double knob = std::hypot(p.u - 0.9 * p.width, p.v - 0.47 * p.height);
  return unit(knob < 0.03 ? 0.95 - 12 * knob : tone);
}

double tiles(const PatternPoint& p) {
  const double tone = cell_noise(p.u / p.size, p.v / p.size, p.seed);
  const double fu = fraction(p.u / p.size), fv = fraction(p.v / p.size);
  const double from_edge = p.size * std::min({fu, 1 - fu, fv, 1 - fv});
  const double glaze = smooth_step(0.002, 0.005, from_edge);
  const double marble = cloud_noise(p.u * 8 + 20 * tone, p.v * 8, 5, p.seed + 1) - 0.5;
  const double specks = value_noise(p.u * 120, p.v * 120, p.seed + 6) - 0.5;
  return unit(glaze * (0.35 + 0.4 * tone + 0.9 * marble + 0.25 * specks) + (1 - glaze) * 0.12);
}

/// Blotches of all sizes and strong contrast.
double speckle(const PatternPoint& p) {
  const double big = cloud_noise(p.u / p.size, p.v / p.size, 3, p.seed) - 0.5;
  const double small = cloud_noise(p.u * 6 / p.size, p.v * 6 / p.size, 3, p.seed + 5) - 0.5;
  return smooth_step(0.15, 0.85, 0.5 + 1.1 * big + 1.0 * small);
}

double grass(const PatternPoint& p) {
  const double blades = cloud_noise(p.u * 45, p.v * 45, 3, p.seed) - 0.5;
  const double clumps = cloud_noise(p.u * 5, p.v * 5, 4, p.seed + 3) - 0.5;
  const double bare = cloud_noise(p.u * 0.6, p.v * 0.6, 4, p.seed + 7) - 0.5;
  return unit(0.42 + 0.7 * blades + 0.6 * clumps + 0.6 * bare);
}

double gravel(const PatternPoint& p) {
  const double stones = value_noise(p.u / p.size * 2, p.v / p.size * 2, p.seed);
  const double grit = cloud_noise(p.u * 60, p.v * 60, 2, p.seed + 1) - 0.5;
  const double patches = cloud_noise(p.u * 1.2, p.v * 1.2, 4, p.seed + 5) - 0.5;
  return unit(0.15 + 0.6 * smooth_step(0.2, 0.7, stones) + 0.5 * grit + 0.5 * patches);
}

double leaves(const PatternPoint& p) {
  const double big = cloud_noise(p.u * 18, p.v * 18, 3, p.seed);
  const double edge = cloud_noise(p.u * 50, p.v * 50, 2, p.seed + 2);
  return unit(1.6 * (big - 0.5) + 0.5 + 0.5 * (edge - 0.5));
}

double sky(const PatternPoint& p) {
  return unit(0.6 + 0.7 * (cloud_noise(p.u / p.size, 2 * p.v / p.size, 6, p.seed) - 0.4));
}

double plain(const PatternPoint&) { return 0.5; }

struct NamedPattern {
  const char* name;
  Pattern pattern;
};

constexpr std::array kPatterns{
    NamedPattern{"planks", planks},
    NamedPattern{"wood", wood},
    NamedPattern{"bricks", bricks},
    NamedPattern{"plaster", plaster},
    NamedPattern{"wallpaper", wallpaper},
    NamedPattern{"fabric", fabric},
    NamedPattern{"carpet", carpet},
    NamedPattern{"rug", rug},
    NamedPattern{"cardboard", cardboard},
    NamedPattern{"books", books},
    NamedPattern{"poster", poster},
    NamedPattern{"window", window},
    NamedPattern{"door", door},
    NamedPattern{"tiles", tiles},
    NamedPattern{"speckle", speckle},
    NamedPattern{"grass", grass},
    NamedPattern{"gravel", gravel},
    NamedPattern{"leaves", leaves},
    NamedPattern{"sky", sky},
    NamedPattern{"plain", plain},
};

}  // namespace

Pattern find_pattern(const std::string& name) {
  std::string allowed;
  for (const NamedPattern& entry : kPatterns) {
    if (name == entry.name) return entry.pattern;
    allowed += (allowed.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw std::runtime_error("pattern must be one of " + allowed + ", got '" + name + "'");
}

}  // namespace flogmap
