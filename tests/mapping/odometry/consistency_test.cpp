#include "mapping/odometry/consistency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "synthetic_matches.hpp"

namespace flogmap {
namespace {

using namespace test;

TEST(LengthSigma, AgreesWithMonteCarlo) {
  std::mt19937 random(3);
  constexpr double kDe = 0.1;
  std::normal_distribution<double> noise(0, kDe);
  const StereoCamera& camera = kMatchCamera;
  const auto seen = [&](const Eigen::Vector3d& p) {  // independent errors of x_l, x_r and the mean row
    const StereoPixel s = project(camera, p);
    const double x_l = s.x() + noise(random), x_r = s.x() - s.z() + noise(random);
    return triangulate(camera, x_l, s.y() + noise(random) / std::sqrt(2.0), x_l - x_r);
  };
  for (int trial = 0; trial < 8; ++trial) {
    const Eigen::Vector3d P1 = random_point(random, 1, 4), P2 = random_point(random, 1, 4);
    const double L = (P1 - P2).norm();
    double sum = 0;
    constexpr int kDraws = 20'000;
    for (int i = 0; i < kDraws; ++i) sum += std::pow((seen(P1) - seen(P2)).norm() - L, 2);
    EXPECT_NEAR(length_sigma(camera, P1, P2, kDe) / std::sqrt(sum / kDraws), 1, 0.03);
  }
}

/// Shares of the true matches found, and of the found ones that are true.
std::pair<double, double> recall_and_precision(const SyntheticMatches& matches, const std::vector<int>& set) {
  const auto num_right = std::count(matches.right.begin(), matches.right.end(), true);
  const auto found = std::count_if(set.begin(), set.end(), [&](int i) { return matches.right[i]; });
  return {static_cast<double>(found) / static_cast<double>(num_right),
          static_cast<double>(found) / static_cast<double>(set.size())};
}

TEST(ConsistentSet, SurvivesFromNoneTo85PercentWrongMatches) {
  std::mt19937 random(11);
  for (const int num_wrong : {0, 50, 150, 284}) {  // 284 of 334: 85 %
    const SE3 motion = random_motion(random, 0.4, 0.3);
    const auto matches = synthetic_matches(random, motion, 50, num_wrong, 0.1);
    const auto set = largest_consistent_set(kMatchCamera, matches.pairs, {.image_sigma_px = 0.1});
    const auto [recall, precision] = recall_and_precision(matches, set);
    EXPECT_GT(recall, 0.8) << num_wrong << " wrong";
    EXPECT_GT(precision, 0.85) << num_wrong << " wrong";
  }
}

TEST(ConsistentSet, MovingObjectIsASmallerSet) {
  std::mt19937 random(5);
  auto matches = synthetic_matches(random, random_motion(random, 0.2, 0.1), 60, 0, 0.05);
  const auto object = synthetic_matches(random, random_motion(random, 0.8, 0.5), 40, 0, 0.05);
  matches.pairs.insert(matches.pairs.end(), object.pairs.begin(), object.pairs.end());
  matches.right.resize(matches.pairs.size(), false);
  const auto set = largest_consistent_set(kMatchCamera, matches.pairs, {.image_sigma_px = 0.05});
  const auto [recall, precision] = recall_and_precision(matches, set);
  EXPECT_GT(recall, 0.8);
  EXPECT_GT(precision, 0.9);
}

TEST(ConsistentSet, RollOf180DegreesPassesOnlyWithoutTheTurnConstraint) {
  std::mt19937 random(9);
  SE3 half_roll = SE3::Identity();
  half_roll.linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto matches = synthetic_matches(random, half_roll, 60, 60, 0.1);
  ConsistencyOptions options{.image_sigma_px = 0.1};
  EXPECT_LT(largest_consistent_set(kMatchCamera, matches.pairs, options).size(), 30U);
  options.max_turn_rad.reset();
  const auto [recall, precision] =
      recall_and_precision(matches, largest_consistent_set(kMatchCamera, matches.pairs, options));
  EXPECT_GT(recall, 0.9);
  EXPECT_GT(precision, 0.9);
}

TEST(ConsistentSet, DoesNotDependOnTheRigidFrame) {
  std::mt19937 random(21);
  const auto matches = synthetic_matches(random, SE3::Identity(), 40, 40, 0.1);
  const auto set = largest_consistent_set(kMatchCamera, matches.pairs, {.image_sigma_px = 0.1});
  EXPECT_TRUE(std::is_sorted(set.begin(), set.end()));
  EXPECT_EQ(set, largest_consistent_set(kMatchCamera, matches.pairs, {.image_sigma_px = 0.1}));
  auto swapped = matches.pairs;
  for (PointPair& pair : swapped) std::swap(pair.in_key, pair.in_current);
  EXPECT_EQ(set, largest_consistent_set(kMatchCamera, swapped, {.image_sigma_px = 0.1}))
      << "and not on its order";
}

TEST(ConsistentSet, OfNothingIsEmpty) { EXPECT_TRUE(largest_consistent_set(kMatchCamera, {}, {}).empty()); }

}  // namespace
}  // namespace flogmap
