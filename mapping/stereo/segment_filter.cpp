#include "mapping/stereo/segment_filter.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace flogmap {
namespace {

/// Disjoint sets of runs; the root of a set is its smallest member and knows how many pixels it has.
class Patches {
 public:
  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    num_px_.push_back(0);
    return parent_.back();
  }

  void count(int patch) { ++num_px_[patch]; }

  int root(int patch) {
    while (parent_[patch] != patch) patch = parent_[patch] = parent_[parent_[patch]];
    return patch;
  }

  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    parent_[b] = a;
    num_px_[a] += num_px_[b];
  }

  int num_px(int patch) { return num_px_[root(patch)]; }

 private:
  std::vector<int> parent_;
  std::vector<int> num_px_;
};

constexpr int kNone = -1;

}  // namespace

void remove_small_segments(DisparityImage& disparity, int min_segment_px, float max_step_px) {
  const int width = disparity.px.width, height = disparity.px.height;
  Patches patches;
  Image<int> patch_of(width, height, kNone);
  for (int y = 0; y < height; ++y) {
    const float* d = disparity.px.row(y);
    const float* above = y > 0 ? disparity.px.row(y - 1) : nullptr;
    int* patch = patch_of.row(y);
    const int* patch_above = above ? patch_of.row(y - 1) : nullptr;
    for (int x = 0; x < width; ++x) {
      if (std::isnan(d[x])) continue;
      // A comparison with NaN is false: an invalid neighbour never joins.
      const bool joins_left = x > 0 && std::abs(d[x] - d[x - 1]) <= max_step_px;
      const bool joins_above = above && std::abs(d[x] - above[x]) <= max_step_px;
      patch[x] = joins_left ? patch[x - 1] : joins_above ? patch_above[x] : patches.add();
      patches.count(patches.root(patch[x]));
      if (joins_left && joins_above && patch[x] != patch_above[x]) patches.join(patch[x], patch_above[x]);
    }
  }
  for (std::size_t i = 0; i < patch_of.size(); ++i) {
    const int patch = patch_of.pixels[i];
    if (patch != kNone && patches.num_px(patch) < min_segment_px) {
      disparity.px.pixels[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

}  // namespace flogmap
