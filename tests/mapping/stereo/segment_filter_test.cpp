#include "mapping/stereo/segment_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace flogmap {
namespace {

constexpr float kInvalid = std::numeric_limits<float>::quiet_NaN();

/// Flood fill from every pixel, as the definition says.
int patch_size(const Image<float>& d, int x0, int y0, float max_step) {
  Image<char> seen(d.width, d.height, 0);
  std::vector<std::pair<int, int>> open{{x0, y0}};
  seen.at(x0, y0) = 1;
  int size = 0;
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    ++size;
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int u = x + dx, v = y + dy;
      if (!d.contains(u, v) || seen.at(u, v) || !(std::abs(d.at(u, v) - d.at(x, y)) <= max_step)) continue;
      seen.at(u, v) = 1;
      open.emplace_back(u, v);
    }
  }
  return size;
}

DisparityImage random_patches(std::mt19937& random, int width, int height) {
  std::uniform_real_distribution<float> uniform(0, 1);
  DisparityImage out{Image<float>(width, height)};
  for (float& d : out.px.pixels)
    d = uniform(random) < 0.25F ? kInvalid : std::floor(uniform(random) * 4) * 0.6F;
  return out;
}

TEST(SegmentFilter, EqualsFloodFillFromEveryPixel) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> side(1, 33), least(0, 40);
  for (int round = 0; round < 60; ++round) {
    const DisparityImage before = random_patches(random, side(random), side(random));
    const int min_px = least(random);
    DisparityImage after = before;
    remove_small_segments(after, min_px, 0.7F);
    for (int y = 0; y < before.px.height; ++y) {
      for (int x = 0; x < before.px.width; ++x) {
        if (std::isnan(before.px.at(x, y)) || patch_size(before.px, x, y, 0.7F) < min_px) {
          EXPECT_TRUE(std::isnan(after.px.at(x, y)));
        } else {
          EXPECT_EQ(after.px.at(x, y), before.px.at(x, y));
        }
      }
    }
  }
}

TEST(SegmentFilter, TwiceIsOnce) {
  std::mt19937 random(5);
  DisparityImage once = random_patches(random, 64, 48);
  remove_small_segments(once, 12);
  DisparityImage twice = once;
  remove_small_segments(twice, 12);
  for (std::size_t i = 0; i < once.px.size(); ++i) {
    EXPECT_EQ(std::isnan(once.px.pixels[i]), std::isnan(twice.px.pixels[i]));
  }
}

TEST(SegmentFilter, AnEmptyImageStaysEmpty) {
  DisparityImage none;
  remove_small_segments(none, 10);
  EXPECT_TRUE(none.px.empty());
}

}  // namespace
}  // namespace flogmap
