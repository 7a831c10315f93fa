#include "mapping/stereo/close_holes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace flogmap {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kWidth = 80, kHeight = 60;

DisparityImage plane() {
  DisparityImage out{Image<float>(kWidth, kHeight)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      out.px.at(x, y) = 8 + 0.03125F * static_cast<float>(x) + 0.0625F * static_cast<float>(y);
    }
  }
  return out;
}

void cut(DisparityImage& disparity, int x0, int y0, int width, int height) {
  for (int y = y0; y < y0 + height; ++y) std::fill_n(disparity.px.row(y) + x0, width, kNone);
}

bool same_bits(const DisparityImage& a, const DisparityImage& b) {
  for (std::size_t i = 0; i < a.px.size(); ++i) {
    const float p = a.px.pixels[i], q = b.px.pixels[i];
    if (std::isnan(p) != std::isnan(q) || (!std::isnan(p) && p != q)) return false;
  }
  return true;
}

TEST(CloseHoles, IsExactOnAPlane) {
  std::mt19937 random(5);
  DisparityImage disparity = plane();
  // Ragged holes that never touch each other or the rim.
  for (int top = 2; top + 9 < kHeight; top += 11) {
    for (int left = 2; left + 9 < kWidth; left += 11) {
      for (int i = 0; i < 20; ++i) {
        cut(disparity, left + static_cast<int>(random() % 7), top + static_cast<int>(random() % 7), 2, 1);
      }
    }
  }
  ASSERT_FALSE(same_bits(disparity, plane()));
  close_holes(disparity);
  for (std::size_t i = 0; i < disparity.px.size(); ++i) {
    EXPECT_NEAR(disparity.px.pixels[i], plane().px.pixels[i], 1e-5);
  }
}

TEST(CloseHoles, ClosesAHundredPixelsAndNoMore) {
  DisparityImage level{Image<float>(kWidth, kHeight, 12.0F)}, small = level, large = level;
  cut(small, 20, 20, 10, 10);
  close_holes(small);
  EXPECT_EQ(small.px, level.px);
  cut(large, 20, 20, 10, 10);
  large.px.at(30, 20) = kNone;
  const DisparityImage before = large;
  close_holes(large);
  EXPECT_TRUE(same_bits(large, before));
}

TEST(CloseHoles, LeavesHolesBetweenTwoSurfacesAndAtTheRim) {
  DisparityImage two = DisparityImage{Image<float>(kWidth, kHeight, 12.0F)};
  for (int y = 0; y < kHeight; ++y) std::fill_n(two.px.row(y) + 40, kWidth - 40, 13.5F);
  cut(two, 37, 20, 3, 3);
  cut(two, 0, 5, 3, 3);
  cut(two, 77, 5, 3, 3);
  cut(two, 10, 0, 3, 3);
  cut(two, 10, 57, 3, 3);
  const DisparityImage before = two;
  close_holes(two);
  EXPECT_TRUE(same_bits(two, before));
}

TEST(CloseHoles, ASecondTimeChangesNothing) {
  std::mt19937 random(9);
  DisparityImage disparity = plane();
  for (float& d : disparity.px.pixels) {
    if (random() % 3 == 0) d = random() % 2 == 0 ? kNone : d + static_cast<float>(random() % 4);
  }
  close_holes(disparity);
  const DisparityImage once = disparity;
  close_holes(disparity);
  EXPECT_TRUE(same_bits(disparity, once));
}

TEST(CloseHoles, LeavesPicturesWithoutAnyAnswer) {
  for (const auto& [width, height] : {std::pair{0, 0}, {1, 1}, {6, 1}, {1, 6}, {9, 9}}) {
    DisparityImage nothing{Image<float>(width, height, kNone)};
    close_holes(nothing);
    for (const float d : nothing.px.pixels) EXPECT_TRUE(std::isnan(d));
  }
}

}  // namespace
}  // namespace flogmap
