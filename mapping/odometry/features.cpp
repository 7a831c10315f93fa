#include "mapping/odometry/features.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

namespace flogmap {
namespace {

constexpr int kStrengthRadiusPx = 3;

/// Smaller eigenvalue of the mean gradient products over 7 x 7 pixels (Shi & Tomasi 1994).
float corner_strength(const Image<std::uint8_t>& image, int x, int y) {
  int xx = 0, xy = 0, yy = 0;
  for (int v = y - kStrengthRadiusPx; v <= y + kStrengthRadiusPx; ++v) {
    const std::uint8_t *above = image.row(v - 1), *here = image.row(v), *below = image.row(v + 1);
    for (int u = x - kStrengthRadiusPx; u <= x + kStrengthRadiusPx; ++u) {
      const int gx = here[u + 1] - here[u - 1];
      const int gy = below[u] - above[u];
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  }
  constexpr float kSide = 2 * kStrengthRadiusPx + 1;
  const float scale = 1 / (4 * kSide * kSide);  // central differences are twice the gradient
  const auto a = static_cast<float>(xx), b = static_cast<float>(xy), c = static_cast<float>(yy);
  return scale * 0.5F * (a + c - std::sqrt((a - c) * (a - c) + 4 * b * b));
}

/// Where the parabola through three values has its top, in (-0.5, 0.5); 0 if it has none.
float parabola_top(float before, float here, float after) {
  const float bend = before - 2 * here + after;
  if (bend >= 0) return 0;
  return std::clamp(0.5F * (before - after) / bend, -0.5F, 0.5F);
}

Corner refine(const Image<std::uint8_t>& image, int x, int y, float strength) {
  const float dx = parabola_top(corner_strength(image, x - 1, y), strength, corner_strength(image, x + 1, y));
  const float dy = parabola_top(corner_strength(image, x, y - 1), strength, corner_strength(image, x, y + 1));
  return {{static_cast<float>(x) + dx, static_cast<float>(y) + dy}, strength};
}

struct Candidate {
  int x = 0, y = 0;
  float strength = 0;
  int rank_in_cell = 0;
};

std::vector<Candidate> fast_corners(const Image<std::uint8_t>& image, int threshold, float min_strength) {
  const cv::Mat mat(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  std::vector<cv::KeyPoint> points;
  cv::FAST(mat, points, threshold, true);
  std::vector<Candidate> candidates;
  candidates.reserve(points.size());
  for (const cv::KeyPoint& point : points) {
    const int x = static_cast<int>(point.pt.x), y = static_cast<int>(point.pt.y);
    const bool inside = x >= kCornerBorderPx && y >= kCornerBorderPx && x < image.width - kCornerBorderPx &&
                        y < image.height - kCornerBorderPx;
    if (!inside) continue;
    const float strength = corner_strength(image, x, y);
    if (strength >= min_strength) candidates.push_back({x, y, strength});
  }
  return candidates;
}

/// Strongest first; pixel order decides between equals.
bool stronger(const Candidate& a, const Candidate& b) {
  if (a.strength != b.strength) return a.strength > b.strength;
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

/// Sorts so that every cell's best come before every cell's second best.
void sort_by_cell(std::vector<Candidate>& candidates, int width, int height, int cell_px) {
  std::sort(candidates.begin(), candidates.end(), stronger);
  const int columns = width / cell_px + 1;
  std::vector<int> num_in_cell(static_cast<std::size_t>(columns) * (height / cell_px + 1), 0);
  for (Candidate& c : candidates) c.rank_in_cell = num_in_cell[c.y / cell_px * columns + c.x / cell_px]++;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.rank_in_cell < b.rank_in_cell; });
}

}  // namespace

std::vector<Corner> detect_corners(const Image<std::uint8_t>& image, const CornerOptions& options) {
  if (std::min(image.width, image.height) <= 2 * kCornerBorderPx) return {};
  auto candidates = fast_corners(image, options.fast_threshold, options.min_strength);
  if (static_cast<int>(candidates.size()) < options.max_corners) {
    candidates = fast_corners(image, std::max(options.fast_threshold / 2, 1), options.min_strength);
  }
  sort_by_cell(candidates, image.width, image.height, options.cell_px);
  std::vector<Corner> corners;
  for (const Candidate& c : candidates) {
    if (static_cast<int>(corners.size()) >= options.max_corners || c.rank_in_cell >= options.max_per_cell) break;
    corners.push_back(refine(image, c.x, c.y, c.strength));
  }
  return corners;
}

}  // namespace flogmap
