#include "mapping/stereo/row_offset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace flogmap {
namespace {

constexpr int kCell = 32;          // at most one corner in each square of so many pixels
constexpr int kHalf = 5;           // a patch is 11 x 11
constexpr int kMostRows = 6;       // looked for so far up and down; the last row is no answer
constexpr int kLeastGradient = 6;  // grey levels per pixel, mean over the patch, along rows and along columns
constexpr int kMostDifference = 14;  // grey levels per pixel
constexpr double kLead = 1.25;       // the second best place is worse by this factor
constexpr std::size_t kLeastMatches = 25;
constexpr double kMostSpread_px = 1;  // between the quartiles
constexpr int kEvery = 64;            // pairs

constexpr int kPixels = (2 * kHalf + 1) * (2 * kHalf + 1);

struct Corner {
  int x = 0, y = 0, strength = 0;
};

/// How much a patch changes along rows and along columns: the lesser of both.
int strength_at(const Image<std::uint8_t>& image, int x, int y) {
  int along = 0, down = 0;
  for (int v = y - kHalf; v <= y + kHalf; ++v) {
    const std::uint8_t* row = image.row(v);
    const std::uint8_t* below = image.row(v + 1);
    for (int u = x - kHalf; u <= x + kHalf; ++u) {
      along += std::abs(row[u + 1] - row[u]);
      down += std::abs(below[u] - row[u]);
    }
  }
  return std::min(along, down);
}

std::vector<Corner> find_corners(const Image<std::uint8_t>& image) {
  constexpr int kBorder = kHalf + kMostRows + 1;
  std::vector<Corner> corners;
  for (int top = kBorder; top + kCell <= image.height - kBorder; top += kCell) {
    for (int left = kBorder; left + kCell <= image.width - kBorder; left += kCell) {
      Corner best;
      for (int y = top; y < top + kCell; y += 4) {
        for (int x = left; x < left + kCell; x += 4) {
          const int strength = strength_at(image, x, y);
          if (strength > best.strength) best = {x, y, strength};
        }
      }
      if (best.strength >= kLeastGradient * kPixels) corners.push_back(best);
    }
  }
  return corners;
}

int difference(const RectifiedFrame& pair, const Corner& corner, int right_x, int right_y, int brightness) {
  int sum = 0;
  for (int v = -kHalf; v <= kHalf; ++v) {
    const std::uint8_t* left = pair.left.row(corner.y + v) + corner.x - kHalf;
    const std::uint8_t* right = pair.right.row(right_y + v) + right_x - kHalf;
    for (int u = 0; u <= 2 * kHalf; ++u) sum += std::abs(left[u] - right[u] - brightness);
  }
  return sum;
}

/// Differences of a corner at every row offset and disparity.
struct Search {
  int rows = 2 * kMostRows + 1, columns = 0;
  std::vector<int> differences;

  [[nodiscard]] int at(int row, int column) const { return differences[row * columns + column]; }
};

/// The row offset of a corner: clearly the best place, and not at the end of the rows looked at.
std::optional<double> row_of_best(const Search& search) {
  const auto best = std::min_element(search.differences.begin(), search.differences.end());
  const auto place = static_cast<int>(best - search.differences.begin());
  const int row = place / search.columns, column = place % search.columns;
  if (*best > kMostDifference * kPixels || row == 0 || row == search.rows - 1) return std::nullopt;
  for (int other_row = 0; other_row < search.rows; ++other_row) {
    for (int other = 0; other < search.columns; ++other) {
      const bool near = std::abs(other_row - row) <= 1 && std::abs(other - column) <= 1;
      if (!near && search.at(other_row, other) < kLead * *best) return std::nullopt;
    }
  }
  const double before = search.at(row - 1, column), after = search.at(row + 1, column);
  const double bend = before + after - 2.0 * *best;
  return row - kMostRows + (bend > 0 ? (before - after) / (2 * bend) : 0);
}

int mean_brightness(const Image<std::uint8_t>& image) {
  std::int64_t sum = 0;
  for (const std::uint8_t pixel : image.pixels) sum += pixel;
  return static_cast<int>(sum / static_cast<std::int64_t>(image.size()));
}

}  // namespace

std::optional<RowOffset> measure_row_offset(const RectifiedFrame& pair, int min_disparity,
                                            int num_disparities) {
  if (pair.left.empty()) return std::nullopt;
  const int brightness = mean_brightness(pair.left) - mean_brightness(pair.right);
  std::vector<double> offsets;
  for (const Corner& corner : find_corners(pair.left)) {
    const int first = std::max(corner.x - min_disparity - num_disparities + 1, kHalf);
    const int last = std::min(corner.x - min_disparity, pair.right.width - kHalf - 1);
    if (last - first < 2) continue;
    Search search{.columns = last - first + 1, .differences = {}};
    for (int dy = -kMostRows; dy <= kMostRows; ++dy) {
      for (int x = first; x <= last; ++x)
        search.differences.push_back(difference(pair, corner, x, corner.y + dy, brightness));
    }
    if (const auto offset = row_of_best(search)) offsets.push_back(*offset);
  }
  if (offsets.size() < kLeastMatches) return std::nullopt;
  std::sort(offsets.begin(), offsets.end());
  const double spread = offsets[offsets.size() * 3 / 4] - offsets[offsets.size() / 4];
  if (spread > kMostSpread_px) return std::nullopt;
  return RowOffset{offsets[offsets.size() / 2], static_cast<int>(offsets.size())};
}

std::string words_of_row_offset(std::optional<double> offset_px) {
  if (!offset_px || std::abs(*offset_px) <= kTolerableRowOffset_px) return {};
  char px[16];
  std::snprintf(px, sizeof px, "%.1f", std::abs(*offset_px));
  return std::string("rows of the right picture lie ") + px + " px " + (*offset_px > 0 ? "lower" : "higher") +
         " than those of the left: the calibration does not fit the cameras any more; calibrate again";
}

std::optional<double> RowWatch::add(const RectifiedFrame& pair) {
  if (frame_++ % kEvery == 0) {
    if (const auto offset = measure_row_offset(pair, min_disparity_, num_disparities_))
      last_px_[num_measured_++ % 3] = offset->median_px;
  }
  if (num_measured_ < 3) return std::nullopt;
  return std::max(std::min(last_px_[0], last_px_[1]),
                  std::min(std::max(last_px_[0], last_px_[1]), last_px_[2]));
}

void RowWatch::reset() { frame_ = num_measured_ = 0; }

}  // namespace flogmap
