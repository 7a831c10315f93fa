#include "mapping/stereo/close_holes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace flogmap {
namespace {

constexpr std::size_t kMostPx = 100;
constexpr float kMostDifferencePx = 1;

class HoleCloser {
 public:
  explicit HoleCloser(Image<float>& px) : px_(px), visited_(px.size(), 0) {}

  void close_all() {
    for (int i = 0; i < static_cast<int>(px_.size()); ++i) {
      if (visited_[i] || !std::isnan(px_.pixels[i])) continue;
      collect(i);
      if (!closable()) continue;
      values_.clear();
      for (const int pixel : hole_)
        values_.push_back(0.5F * (between_ends(pixel, 1) + between_ends(pixel, px_.width)));
      for (std::size_t k = 0; k < hole_.size(); ++k) px_.pixels[hole_[k]] = values_[k];
    }
  }

 private:
  /// All invalid pixels that hang together with pixel `first`, and what surrounds them.
  void collect(int first) {
    hole_.assign(1, first);
    visited_[first] = 1;
    least_px_ = std::numeric_limits<float>::max();
    most_px_ = std::numeric_limits<float>::lowest();
    touches_rim_ = false;
    for (std::size_t i = 0; i < hole_.size(); ++i) {
      const int pixel = hole_[i], x = pixel % px_.width, y = pixel / px_.width;
      if (x == 0 || y == 0 || x + 1 == px_.width || y + 1 == px_.height) touches_rim_ = true;
      if (x > 0) look_at(pixel - 1);
      if (x + 1 < px_.width) look_at(pixel + 1);
      if (y > 0) look_at(pixel - px_.width);
      if (y + 1 < px_.height) look_at(pixel + px_.width);
    }
  }

  void look_at(int pixel) {
    const float d = px_.pixels[pixel];
    if (!std::isnan(d)) {
      least_px_ = std::min(least_px_, d);
      most_px_ = std::max(most_px_, d);
    } else if (!visited_[pixel]) {
      visited_[pixel] = 1;
      hole_.push_back(pixel);
    }
  }

  [[nodiscard]] bool closable() const {
    return !touches_rim_ && hole_.size() <= kMostPx && most_px_ - least_px_ <= kMostDifferencePx;
  }

  /// On the straight line between the ends of the hole that `stride` leads to.
  [[nodiscard]] float between_ends(int pixel, int stride) const {
    int before = pixel, after = pixel;
    while (std::isnan(px_.pixels[before])) before -= stride;
    while (std::isnan(px_.pixels[after])) after += stride;
    const float share = static_cast<float>(pixel - before) / static_cast<float>(after - before);
    return px_.pixels[before] + share * (px_.pixels[after] - px_.pixels[before]);
  }

  Image<float>& px_;
  std::vector<std::uint8_t> visited_;
  std::vector<int> hole_;
  std::vector<float> values_;  // of the hole's pixels
  float least_px_ = 0, most_px_ = 0;
  bool touches_rim_ = false;
};

}  // namespace

void close_holes(DisparityImage& disparity) { HoleCloser(disparity.px).close_all(); }

}  // namespace flogmap
