#include "mapping/flog/membership.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace flogmap {
namespace {

struct Beam {
  double r, l, m;
};

std::vector<Beam> random_beams(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> range_m(0.3, 8), share(0, 1.3), width_m(0.01, 0.3);
  std::vector<Beam> beams;
  for (int i = 0; i < count; ++i) {
    const double l = range_m(random);
    beams.push_back({share(random) * l, l, width_m(random)});
  }
  return beams;
}

TEST(Membership, EmptyAndOccupiedSumToOneBeforeTheHit) {
  for (const Beam& b : random_beams(1, 10'000)) {
    if (b.r < b.l) {
      EXPECT_NEAR(mu_E(b.r, b.l, b.m) + mu_O(b.r, b.l, b.m), 1, 1e-12);
    }
  }
}

TEST(Membership, LiesBetweenZeroAndOneAndTheSumDoesToo) {
  for (const Beam& b : random_beams(2, 10'000)) {
    const double E = mu_E(b.r, b.l, b.m), O = mu_O(b.r, b.l, b.m);
    EXPECT_GE(E, 0);
    EXPECT_GE(O, 0);
    EXPECT_LE(E + O, 1 + 1e-12);
  }
}

TEST(Membership, OccupiedIsSymmetricAboutTheHitAndOneAtIt) {
  for (const Beam& b : random_beams(3, 10'000)) {
    EXPECT_EQ(mu_O(b.l, b.l, b.m), 1);
    const double away = std::abs(b.r - b.l);
    if (away < b.l) {
      EXPECT_NEAR(mu_O(b.l - away, b.l, b.m), mu_O(b.l + away, b.l, b.m), 1e-9);
    }
  }
}

TEST(Membership, SaysNothingBehindTheHitsWidth) {
  for (const Beam& b : random_beams(4, 10'000)) {
    const double behind = b.l + b.m + b.r * 1e-3;
    EXPECT_EQ(mu_E(behind, b.l, b.m), 0);
    EXPECT_EQ(mu_O(behind, b.l, b.m), 0);
  }
}

TEST(Membership, OccupiedIsAPartitionOfUnityOverPointsOneWidthApart) {
  for (const Beam& b : random_beams(5, 1'000)) {
    double sum = 0;
    const double first = b.l - 3 * b.m + std::fmod(b.r, b.m);
    for (int i = 0; i < 7; ++i) sum += mu_O(first + i * b.m, b.l, b.m);
    if (first > 0) {
      EXPECT_NEAR(sum, 1, 1e-9);
    }
  }
}

constexpr StereoCamera kCamera{435, 376, 240, 0.11, 752, 480};

TEST(RangeError, PaperModeIsTooLargeByExactlyRangeOverDepth) {
  const RangeError exact = range_error(kCamera, 0.02, false), paper = range_error(kCamera, 0.02, true);
  for (const double l_over_Z : {1.0, 1.11, 1.39}) {
    const double Z = 2.5, l = Z * l_over_Z;
    EXPECT_NEAR(delta_l(paper, l, Z) / delta_l(exact, l, Z), l_over_Z, 1e-12);
  }
}

TEST(RangeError, AgreesWithNoiseOnTheDisparity) {
  const double Z = 3, f = kCamera.focal_px, t = kCamera.baseline_m, d = f * t / Z;
  std::mt19937 random(6);
  std::normal_distribution<double> image_error(0, kImageSigmaPx);
  double sum = 0, sum_of_squares = 0;
  const int count = 100'000;
  for (int i = 0; i < count; ++i) {
    const double l = triangulate(kCamera, 650, 100, d + image_error(random) - image_error(random)).norm();
    sum += l;
    sum_of_squares += l * l;
  }
  const double mean = sum / count, l = triangulate(kCamera, 650, 100, d).norm();
  const double sigma = std::sqrt(sum_of_squares / count - mean * mean);
  EXPECT_NEAR(delta_l(range_error(kCamera, 0.02, false), l, Z), sigma, 0.02 * sigma);
}

TEST(RangeError, WidthHasTheCellAsFloorUnlessInPaperMode) {
  EXPECT_EQ(membership_width(range_error(kCamera, 0.02, false), 0.5, 0.5), 0.02);
  EXPECT_LT(membership_width(range_error(kCamera, 0.02, true), 0.5, 0.5), 0.005);
  const RangeError far = range_error(kCamera, 0.02, false);
  EXPECT_EQ(membership_width(far, 5, 4), 3 * delta_l(far, 5, 4));
}

}  // namespace
}  // namespace flogmap
