#include "mapping/odometry/features.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace flogmap {
namespace {

constexpr int kRadiusPx = 4;  // of the window over which gradients are gathered
constexpr int kSidePx = 2 * kRadiusPx + 1;
constexpr int kBlockPx = 6;  // at most one corner in a block of this side

Image<std::uint8_t> blurred(const Image<std::uint8_t>& image) {
  Image<std::uint8_t> smooth(image.width, image.height);
  const cv::Mat from(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat to(image.height, image.width, CV_8U, smooth.pixels.data());
  cv::blur(from, to, cv::Size(3, 3));
  return smooth;
}

/// Products of the gradients along one row, for every column.
struct GradientProducts {
  std::vector<std::int32_t> xx, xy, yy;

  explicit GradientProducts(int width) : xx(width, 0), xy(width, 0), yy(width, 0) {}

  /// Adds (sign 1) or takes away (sign -1) the products of row y.
  void add_row(const Image<std::uint8_t>& image, int y, std::int32_t sign) {
    const std::uint8_t *above = image.row(y - 1), *here = image.row(y), *below = image.row(y + 1);
    for (int x = 1; x < image.width - 1; ++x) {
      const auto gx =
          static_cast<std::int16_t>(here[x + 1] - here[x - 1]);  // 16 bit: twice as many at a time
      const auto gy = static_cast<std::int16_t>(below[x] - above[x]);
      xx[x] += sign * (std::int32_t{gx} * gx);
      xy[x] += sign * (std::int32_t{gx} * gy);
      yy[x] += sign * (std::int32_t{gy} * gy);
    }
  }
};

/// sums[x]: sum over the kSidePx columns around x, for columns [kRadiusPx, width - kRadiusPx). Sums of 2, 4
/// and 8 neighbours, one after the other, go many columns at a time; a running sum does not.
void box_sum(const std::vector<std::int32_t>& values, std::vector<std::int32_t>& scratch,
             std::vector<float>& sums) {
  static_assert(kSidePx == 9);
  const int n = static_cast<int>(values.size()) - kSidePx + 1;
  const std::int32_t* v = values.data();
  std::int32_t* s = scratch.data();
  float* out = sums.data() + kRadiusPx;
  for (int x = 0; x < n + 6; ++x) s[x] = v[x] + v[x + 1];
  for (int x = 0; x < n + 4; ++x) s[x] += s[x + 2];
  for (int x = 0; x < n; ++x) out[x] = static_cast<float>(s[x] + s[x + 4] + v[x + 8]);
}

/// Smaller eigenvalue of the mean gradient products around every pixel (Shi & Tomasi 1994); 0 at the border.
Image<float> strength_map(const Image<std::uint8_t>& image) {
  Image<float> strength(image.width, image.height, 0.0F);
  GradientProducts columns(image.width);
  std::vector<float> xx(image.width, 0.0F), xy(image.width, 0.0F), yy(image.width, 0.0F);
  std::vector<std::int32_t> scratch(image.width);
  constexpr float kScale = 0.5F / (4 * kSidePx * kSidePx);  // central differences are twice the gradient
  for (int y = 1; y < kSidePx; ++y) columns.add_row(image, y, 1);
  for (int y = kRadiusPx + 1; y + kRadiusPx + 1 < image.height; ++y) {
    columns.add_row(image, y + kRadiusPx, 1);
    box_sum(columns.xx, scratch, xx);
    box_sum(columns.xy, scratch, xy);
    box_sum(columns.yy, scratch, yy);
    float* out = strength.row(y);
    for (int x = 0; x < image.width; ++x) {
      const float difference = xx[x] - yy[x];
      out[x] = kScale * (xx[x] + yy[x] - std::sqrt(difference * difference + 4 * xy[x] * xy[x]));
    }
    columns.add_row(image, y - kRadiusPx, -1);
  }
  return strength;
}

struct Candidate {
  int x = 0, y = 0;
  float strength = 0;
  int rank_in_cell = 0;
};

/// Marks the pixels of row y that none of their eight neighbours surpasses.
void mark_summits(const Image<float>& strength, int y, float least, std::vector<float>& tops,
                  std::vector<std::uint8_t>& marks) {
  const float *above = strength.row(y - 1), *here = strength.row(y), *below = strength.row(y + 1);
  float* __restrict top = tops.data();
  std::uint8_t* __restrict mark = marks.data();
  const int width = strength.width;
  for (int x = 0; x < width; ++x) top[x] = std::max(std::max(above[x], below[x]), here[x]);
  for (int x = 1; x < width - 1; ++x) {
    const float highest = std::max(std::max(top[x - 1], top[x + 1]), std::max(top[x], least));
    mark[x] = static_cast<std::uint8_t>(here[x] >= highest);
  }
}

/// The strongest summit of every block that has one of at least that strength.
std::vector<Candidate> summits(const Image<float>& strength, float least) {
  const int right = strength.width - kCornerBorderPx, bottom = strength.height - kCornerBorderPx;
  const int columns = (right - kCornerBorderPx) / kBlockPx + 1;
  std::vector<Candidate> row_of_blocks(columns), candidates;
  std::vector<float> tops(strength.width);
  std::vector<std::uint8_t> marks(strength.width, 0);
  for (int y = kCornerBorderPx; y < bottom; ++y) {
    mark_summits(strength, y, least, tops, marks);
    const auto end = marks.begin() + right;
    for (auto m = marks.begin() + kCornerBorderPx; (m = std::find(m, end, 1)) != end; ++m) {
      const int x = static_cast<int>(m - marks.begin());
      Candidate& best = row_of_blocks[(x - kCornerBorderPx) / kBlockPx];
      if (strength.at(x, y) > best.strength) best = {x, y, strength.at(x, y)};
    }
    if ((y - kCornerBorderPx) % kBlockPx != kBlockPx - 1 && y + 1 != bottom) continue;
    for (Candidate& best : row_of_blocks) {
      if (best.strength > 0) candidates.push_back(std::exchange(best, {}));
    }
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

/// Where the parabola through three values has its top, in [-0.5, 0.5]; 0 if it has none.
float parabola_top(float before, float here, float after) {
  const float bend = before - 2 * here + after;
  if (bend >= 0) return 0;
  return std::clamp(0.5F * (before - after) / bend, -0.5F, 0.5F);
}

Corner refine(const Image<float>& strength, const Candidate& c) {
  const float dx = parabola_top(strength.at(c.x - 1, c.y), c.strength, strength.at(c.x + 1, c.y));
  const float dy = parabola_top(strength.at(c.x, c.y - 1), c.strength, strength.at(c.x, c.y + 1));
  return {{static_cast<float>(c.x) + dx, static_cast<float>(c.y) + dy}, c.strength};
}

}  // namespace

std::vector<Corner> detect_corners(const Image<std::uint8_t>& image, const CornerOptions& options) {
  if (std::min(image.width, image.height) <= 2 * kCornerBorderPx) return {};
  const Image<float> strength = strength_map(blurred(image));
  auto candidates = summits(strength, options.min_strength);
  sort_by_cell(candidates, image.width, image.height, options.cell_px);
  std::vector<Corner> corners;
  for (const Candidate& c : candidates) {
    if (static_cast<int>(corners.size()) >= options.max_corners || c.rank_in_cell >= options.max_per_cell)
      break;
    corners.push_back(refine(strength, c));
  }
  return corners;
}

}  // namespace flogmap
