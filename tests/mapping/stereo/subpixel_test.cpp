#include "mapping/stereo/subpixel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "tests/mapping/stereo/synthetic_pair.hpp"

namespace flogmap {
namespace {

constexpr int kWidth = 240, kHeight = 120, kBorder = 6;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

double plane(int x, int y) { return 9 + 0.06 * x + 0.035 * y; }

/// What a matcher that knows whole pixels alone would say, drawn halfway to the truth.
DisparityImage drawn_to_whole_pixels() {
  DisparityImage d{Image<float>(kWidth, kHeight)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      d.px.at(x, y) = static_cast<float>(0.5 * (plane(x, y) + std::round(plane(x, y))));
    }
  }
  return d;
}

struct Errors {
  double rms = 0;
  std::vector<double> mean_at_eighth = std::vector<double>(8, 0);
};

Errors errors_of(const DisparityImage& d) {
  Errors errors;
  std::vector<double> count(8, 0);
  for (int y = kBorder; y < kHeight - kBorder; ++y) {
    for (int x = 40; x < kWidth - kBorder; ++x) {
      const double error = d.px.at(x, y) - plane(x, y);
      const auto eighth = static_cast<std::size_t>((plane(x, y) - std::floor(plane(x, y))) * 8);
      errors.rms += error * error;
      errors.mean_at_eighth[eighth] += error;
      ++count[eighth];
    }
  }
  double all = 0;
  for (std::size_t i = 0; i < 8; ++i) errors.mean_at_eighth[i] /= count[i], all += count[i];
  errors.rms = std::sqrt(errors.rms / all);
  return errors;
}

class Subpixel : public testing::Test {
 protected:
  std::mt19937 random_{7};
  RectifiedFrame pair_ = pair_of_surface(random_, kWidth, kHeight, plane);
};

TEST_F(Subpixel, ASlantedPlaneLosesItsSteps) {
  DisparityImage d = drawn_to_whole_pixels();
  ASSERT_GT(errors_of(d).rms, 0.13);
  SubpixelFit(0, 1).refine(d, pair_);
  const Errors after = errors_of(d);
  EXPECT_LT(after.rms, 0.04);
  for (const double mean : after.mean_at_eighth) EXPECT_NEAR(mean, 0, 0.05);
}

TEST_F(Subpixel, AnotherExposureOnOneSideHardlyMatters) {
  for (std::uint8_t& grey : pair_.right.pixels) grey = static_cast<std::uint8_t>(25 + 0.8 * grey);
  DisparityImage d = drawn_to_whole_pixels();
  SubpixelFit(0, 1).refine(d, pair_);
  EXPECT_LT(errors_of(d).rms, 0.05);
}

TEST_F(Subpixel, SensorNoiseDoesNotMakeAnswersWorse) {
  add_noise(random_, 6, pair_);
  DisparityImage d = drawn_to_whole_pixels();
  SubpixelFit(0, 1).refine(d, pair_);
  EXPECT_LT(errors_of(d).rms, 0.06);
}

TEST_F(Subpixel, APlainSurfaceKeepsItsAnswers) {
  for (Image<std::uint8_t>* image : {&pair_.left, &pair_.right}) {
    std::fill(image->pixels.begin(), image->pixels.end(), std::uint8_t{90});
  }
  add_noise(random_, 1, pair_);
  DisparityImage d{Image<float>(kWidth, kHeight, 12.25F)};
  SubpixelFit(0, 1).refine(d, pair_);
  for (const float value : d.px.pixels) EXPECT_NEAR(value, 12.25F, 0.3F);
}

TEST_F(Subpixel, NoAnswerStaysNoAnswerAndNeighboursOfAHoleAreFitted) {
  DisparityImage d = drawn_to_whole_pixels();
  for (int y = 50; y < 60; ++y) {
    for (int x = 100; x < 110; ++x) d.px.at(x, y) = kNone;
  }
  SubpixelFit(0, 1).refine(d, pair_);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool hole = y >= 50 && y < 60 && x >= 100 && x < 110;
      EXPECT_EQ(std::isnan(d.px.at(x, y)), hole) << x << ',' << y;
    }
  }
  for (int y = 48; y < 62; ++y) EXPECT_NEAR(d.px.at(98, y), plane(98, y), 0.15);
}

TEST_F(Subpixel, AStepInDepthIsNotSmoothedAway) {
  const BoxPair box = box_pair(random_, kWidth, kHeight, 20, 8);
  DisparityImage d{Image<float>(kWidth, kHeight)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) d.px.at(x, y) = static_cast<float>(box.on_box(x, y) ? 20 : 8);
  }
  SubpixelFit(0, 1).refine(d, box.frame);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 8; x < kWidth; ++x)
      EXPECT_NEAR(d.px.at(x, y), box.on_box(x, y) ? 20 : 8, 1) << x << ',' << y;
  }
}

TEST_F(Subpixel, TheSameBitsOnAnyNumberOfThreadsAndWhateverCameBefore) {
  SubpixelFit one(0, 1), three(0, 3);
  DisparityImage small{Image<float>(31, 17, 4.5F)}, a = drawn_to_whole_pixels(), b = a;
  three.refine(small, pair_of_surface(random_, 31, 17, [](int, int) { return 4.5; }));
  one.refine(a, pair_);
  three.refine(b, pair_);
  EXPECT_EQ(std::memcmp(a.px.pixels.data(), b.px.pixels.data(), a.px.size() * sizeof(float)), 0);
}

TEST_F(Subpixel, NothingFallsBelowTheLeastDisparity) {
  DisparityImage d{Image<float>(kWidth, kHeight, 10.0F)};
  SubpixelFit(10, 1).refine(d, shifted_pair(random_, kWidth, kHeight, 9.5));
  for (const float value : d.px.pixels) EXPECT_GE(value, 10);
}

}  // namespace
}  // namespace flogmap
