#include "mapping/stereo/border_correction.hpp"

#include <cmath>
#include <cstdlib>

namespace flogmap {
namespace {

constexpr int kReachPx = 5;             // half a window of the census and its sum, and two for the paths
constexpr float kSameSurfacePx = 1.5F;  // neighbours that differ by more lie at a depth edge
constexpr int kMayMatchWorse = 8;       // brightness: noise and sampling
constexpr int kClearlyStronger = 8;     // brightness, beside twice the step at the depth edge

struct Pixel {
  int x, y;
};
struct Step {
  int x, y;
};
Pixel operator+(Pixel p, Step s) { return {p.x + s.x, p.y + s.y}; }
Step operator-(Step s) { return {-s.x, -s.y}; }

bool at_edge(float a, float b) { return std::abs(a - b) > kSameSurfacePx; }  // false for NaN

class BorderCorrection {
 public:
  BorderCorrection(const Image<float>& matched, const RectifiedFrame& pair, Image<float>& corrected)
      : matched_(matched), pair_(pair), corrected_(corrected) {}

  /// A depth edge lies between the neighbours p and p + step.
  void between(Pixel p, Step step) {
    const float here = at(p), there = at(p + step);
    if (here > there) {
      give_back(p, -step, there);
    } else {
      give_back(p + step, step, here);
    }
  }

 private:
  /// Walks from the depth edge into the nearer surface; `first` is its outermost pixel.
  void give_back(Pixel first, Step inwards, float far_px) {
    const float near_px = at(first);
    int strongest = 2 * brightness_step(first, first + -inwards) + kClearlyStronger;
    int count = 0;
    Pixel p = first;
    for (int i = 1; i <= kReachPx; ++i) {
      const Pixel next = p + inwards;
      if (!matched_.contains(next.x, next.y) || !(std::abs(at(p) - near_px) <= kSameSurfacePx)) break;
      if (mismatch(p, far_px) > mismatch(p, at(p)) + kMayMatchWorse) break;
      if (const int step = brightness_step(p, next); step > strongest) {
        strongest = step;
        count = i;
      }
      p = next;
    }
    for (p = first; count > 0; --count, p = p + inwards) corrected_.at(p.x, p.y) = far_px;
  }

  [[nodiscard]] float at(Pixel p) const { return matched_.at(p.x, p.y); }

  [[nodiscard]] int brightness_step(Pixel a, Pixel b) const {
    return std::abs(pair_.left.at(a.x, a.y) - pair_.left.at(b.x, b.y));
  }

  /// How much the pictures differ at a disparity; more than any brightness outside the right picture.
  [[nodiscard]] int mismatch(Pixel p, float disparity_px) const {
    const int right_x = static_cast<int>(std::lround(static_cast<float>(p.x) - disparity_px));
    if (right_x < 0 || right_x >= pair_.right.width) return 1000;
    return std::abs(pair_.left.at(p.x, p.y) - pair_.right.at(right_x, p.y));
  }

  const Image<float>& matched_;
  const RectifiedFrame& pair_;
  Image<float>& corrected_;
};

}  // namespace

void correct_borders(DisparityImage& disparity, const RectifiedFrame& pair) {
  const Image<float> matched = disparity.px;
  BorderCorrection correction(matched, pair, disparity.px);
  for (int y = 0; y < matched.height; ++y) {
    const float* d = matched.row(y);
    for (int x = 0; x + 1 < matched.width; ++x) {
      if (at_edge(d[x], d[x + 1])) correction.between({x, y}, {1, 0});
    }
  }
  for (int y = 0; y + 1 < matched.height; ++y) {
    const float *d = matched.row(y), *below = matched.row(y + 1);
    for (int x = 0; x < matched.width; ++x) {
      if (at_edge(d[x], below[x])) correction.between({x, y}, {0, 1});
    }
  }
}

}  // namespace flogmap
