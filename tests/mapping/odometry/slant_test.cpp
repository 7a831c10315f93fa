#include "mapping/odometry/slant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "mapping/odometry/frame_features.hpp"
#include "textured_room.hpp"

namespace flogmap {
namespace {

using namespace test;

constexpr int kWidth = 120, kHeight = 90;
constexpr double kX = 60, kY = 45, kDisparity_px = 12;

/// Disparities of a slanted surface, with noise.
DisparityImage surface(const Slant& slant, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.1);
  DisparityImage disparity{Image<float>(kWidth, kHeight)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double d = kDisparity_px + slant.dot(Eigen::Vector2d(x - kX, y - kY)) + noise(random);
      disparity.px.at(x, y) = static_cast<float>(d);
    }
  }
  return disparity;
}

/// A textured surface of that slant, as both cameras see it.
RectifiedFrame textured_surface(const Slant& slant, std::uint32_t seed) {
  const auto grey = [seed](double x, double y) {
    return static_cast<std::uint8_t>(40.5 + 150 * value_noise(x / 5, y / 5, seed));
  };
  RectifiedFrame frame{.timestamp_ns = 1,
                       .left = Image<std::uint8_t>(kWidth, kHeight),
                       .right = Image<std::uint8_t>(kWidth, kHeight)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      frame.left.at(x, y) = grey(x, y);
      const double from_middle = x + kDisparity_px - kX + slant.y() * (y - kY);
      frame.right.at(x, y) = grey(kX + from_middle / (1 - slant.x()), y);
    }
  }
  return frame;
}

Slant random_slant(std::mt19937& random) {
  std::uniform_real_distribution<double> size(0.1, 0.4), direction(-3.1, 3.1);
  const double a = direction(random);
  return size(random) * Slant(std::cos(a), std::sin(a));
}

TEST(Slant, OfAPlaneIsItsGradient) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const Slant slant = random_slant(random);
    const Slant found = slant_at(surface(slant, random), {kX, kY}, kDisparity_px);
    EXPECT_LE((found - slant).norm(), 0.02) << slant.transpose();
  }
}

TEST(Slant, IsThatOfTheCornersOwnSurfaceBesideANearerOne) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    const Slant slant = random_slant(random);
    DisparityImage disparity = surface(slant, random);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = static_cast<int>(kX) + 4; x < kWidth; ++x) disparity.px.at(x, y) += 20;
    }
    EXPECT_LE((slant_at(disparity, {kX, kY}, kDisparity_px) - slant).norm(), 0.04) << slant.transpose();
  }
}

TEST(Slant, IsNoneWhereDisparitiesAreFewOrOfNoPlane) {
  std::mt19937 random(3);
  DisparityImage few = surface({0.3, 0.1}, random), rough = few;
  std::bernoulli_distribution missing(0.6);
  std::uniform_real_distribution<float> error(-1.5F, 1.5F);
  for (float& d : few.px.pixels) {
    if (missing(random)) d = std::numeric_limits<float>::quiet_NaN();
  }
  for (float& d : rough.px.pixels) d += error(random);
  EXPECT_TRUE(slant_at(few, {kX, kY}, kDisparity_px).isZero());
  EXPECT_TRUE(slant_at(rough, {kX, kY}, kDisparity_px).isZero());
}

TEST(Slant, LetsADisparityBeThatOfThePixelAndNotOfTheTextureAroundIt) {
  std::mt19937 random(4);
  double told = 0, untold = 0;
  int count = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Slant slant = random_slant(random);
    const RectifiedFrame frame = textured_surface(slant, seed);
    const auto with = refine_disparity(frame, {kX, kY}, kDisparity_px + 0.4, slant);
    const auto without = refine_disparity(frame, {kX, kY}, kDisparity_px + 0.4, Slant::Zero());
    if (!with || !without) continue;
    told += (*with - kDisparity_px) * (*with - kDisparity_px);
    untold += (*without - kDisparity_px) * (*without - kDisparity_px);
    ++count;
  }
  ASSERT_GE(count, 20);
  EXPECT_LE(std::sqrt(told / count), 0.05);
  EXPECT_GE(std::sqrt(untold / count), 3 * std::sqrt(told / count)) << "the test would not notice";
}

}  // namespace
}  // namespace flogmap
