#include "mapping/flog/distance_field.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace flogmap {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Lower envelope of the parabolas (x - q)^2 + height[q] with finite heights.
class Envelope {
 public:
  explicit Envelope(std::size_t size) : apex_(size), from_(size + 1), height_(size) {}

  std::vector<double>& height() { return height_; }

  void build(int size) {
    last_ = -1;
    for (int q = 0; q < size; ++q) {
      if (height_[q] == kFar) continue;
      double from = -kFar;
      while (last_ >= 0 && (from = crossing(q, apex_[last_])) <= from_[last_]) --last_;
      if (last_ < 0) from = -kFar;
      apex_[++last_] = q;
      from_[last_] = from;
    }
    from_[last_ + 1] = kFar;
    at_ = 0;
  }

  /// Value at x; x must not fall from call to call.
  double at(int x) {
    if (last_ < 0) return kFar;
    while (from_[at_ + 1] < x) ++at_;
    const double away = x - apex_[at_];
    return away * away + height_[apex_[at_]];
  }

 private:
  [[nodiscard]] double crossing(int q, int p) const {
    return ((height_[q] + double{1} * q * q) - (height_[p] + double{1} * p * p)) / (2.0 * (q - p));
  }

  std::vector<int> apex_;
  std::vector<double> from_;
  std::vector<double> height_;
  int last_ = -1;
  int at_ = 0;
};

}  // namespace

Image<float> distance_to_blocked(const Image<std::uint8_t>& blocked) {
  const int width = blocked.width, height = blocked.height;
  Image<double> squared(width, height, kFar);
  Envelope column(height), row(width);
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y) column.height()[y] = blocked.at(x, y) != 0 ? 0.0 : kFar;
    column.build(height);
    for (int y = 0; y < height; ++y) squared.at(x, y) = column.at(y);
  }
  Image<float> distance(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) row.height()[x] = squared.at(x, y);
    row.build(width);
    for (int x = 0; x < width; ++x) distance.at(x, y) = static_cast<float>(std::sqrt(row.at(x)));
  }
  return distance;
}

}  // namespace flogmap
