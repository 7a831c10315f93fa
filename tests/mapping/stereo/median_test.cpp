#include "mapping/stereo/median.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace flogmap {
namespace {

float median_by_sorting(const Image<float>& d, int x, int y) {
  std::vector<float> values;
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      const bool valid = d.contains(u, v) && !std::isnan(d.at(u, v));
      values.push_back(valid ? d.at(u, v) : d.at(x, y));
    }
  }
  std::sort(values.begin(), values.end());
  return values[4];
}

TEST(Median, EqualsSortingTheNeighbourhoodAndLeavesHolesOpen) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const auto& [width, height] : {std::pair{37, 75}, {1, 9}, {9, 1}, {2, 2}}) {
    DisparityImage before{Image<float>(width, height)};
    for (float& d : before.px.pixels) {
      d = uniform(random) < 0.3F ? std::numeric_limits<float>::quiet_NaN() : 64 * uniform(random);
    }
    DisparityImage after = before;
    median_3x3(after, 2);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (std::isnan(before.px.at(x, y))) {
          EXPECT_TRUE(std::isnan(after.px.at(x, y)));
        } else {
          EXPECT_EQ(after.px.at(x, y), median_by_sorting(before.px, x, y));
        }
      }
    }
  }
}

}  // namespace
}  // namespace flogmap
