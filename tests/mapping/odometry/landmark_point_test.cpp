#include "mapping/odometry/landmark_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "synthetic_matches.hpp"

namespace flogmap {
namespace {

using namespace test;

constexpr double kImageSigma_px = 0.08, kDisparitySigma_px = 0.15;

/// Cameras around the first one, up to 0.4 m and 0.1 rad away, that have the point before them.
std::vector<PlacedSighting> exact_sightings(std::mt19937& random, const Eigen::Vector3d& point, int count) {
  std::uniform_real_distribution<double> metres(0.05, 0.4);
  std::vector<PlacedSighting> sightings{{SE3::Identity(), project(kMatchCamera, point)}};
  while (static_cast<int>(sightings.size()) < count) {
    const SE3 pose = random_motion(random, metres(random), 0.1);
    sightings.push_back({pose, project(kMatchCamera, pose * point)});
  }
  return sightings;
}

std::vector<PlacedSighting> noisy_sightings(std::mt19937& random, const Eigen::Vector3d& point, int count) {
  std::normal_distribution<double> normal;
  auto sightings = exact_sightings(random, point, count);
  for (PlacedSighting& s : sightings) {
    s.pixel += StereoPixel(kImageSigma_px * normal(random), kImageSigma_px * normal(random),
                           kDisparitySigma_px * normal(random));
  }
  return sightings;
}

std::optional<LandmarkPoint> refined(const std::vector<PlacedSighting>& sightings) {
  const Eigen::Vector3d anchored =
      sightings.front().camera_from_odometry.inverse() * triangulate(kMatchCamera, sightings.front().pixel);
  return refine_point(kMatchCamera, sightings, anchored, kDisparitySigma_px);
}

TEST(LandmarkPoint, ExactSightingsLeaveItExact) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector3d point = random_point(random, 1, 6);
    const auto sightings = exact_sightings(random, point, 2 + trial % 7);
    const auto found = refine_point(kMatchCamera, sightings, point * 1.02, kDisparitySigma_px);
    ASSERT_TRUE(found);
    EXPECT_LT((found->in_odometry - point).norm(), 1e-5);
  }
}

TEST(LandmarkPoint, ErrorIsWhatTheCovarianceSays) {
  std::mt19937 random(2);
  constexpr int kTrials = 600;
  double sum = 0;  // normalised estimation error squared
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d point = random_point(random, 1, 6);
    const auto found = refined(noisy_sightings(random, point, 6));
    ASSERT_TRUE(found);
    const Eigen::Vector3d error = found->in_odometry - point;
    sum += error.dot(found->covariance.ldlt().solve(error));
  }
  // chi^2 with 3 degrees of freedom has the mean 3. The lower weights of ordinary errors are not made up for:
  // the poses are not exact either.
  EXPECT_GT(sum / kTrials, 1.5);
  EXPECT_LT(sum / kTrials, 3.2);
}

TEST(LandmarkPoint, SixSightingsAreBetterThanOne) {
  std::mt19937 random(3);
  double alone = 0, together = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d point = random_point(random, 1, 6);
    const auto sightings = noisy_sightings(random, point, 6);
    const auto found = refined(sightings);
    ASSERT_TRUE(found);
    alone += std::pow(triangulate(kMatchCamera, sightings.front().pixel).z() / point.z() - 1, 2);
    together += std::pow(found->in_odometry.z() / point.z() - 1, 2);
  }
  EXPECT_LT(together, alone / 5);  // six disparities, and parallax besides
}

TEST(LandmarkPoint, AWrongSightingDoesNotBendIt) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector3d point = random_point(random, 1, 4);
    auto sightings = exact_sightings(random, point, 6);
    sightings[1 + trial % 5].pixel += StereoPixel(3, -2, 1);
    const auto found = refined(sightings);
    ASSERT_TRUE(found);
    EXPECT_LT((project(kMatchCamera, found->in_odometry) - sightings.front().pixel).norm(), 0.05);
  }
}

TEST(LandmarkPoint, OrderOfLaterSightingsDoesNotMatter) {
  std::mt19937 random(5);
  auto sightings = noisy_sightings(random, {0.3, -0.2, 2.5}, 8);
  const auto found = refined(sightings);
  std::shuffle(sightings.begin() + 1, sightings.end(), random);
  const auto shuffled = refined(sightings);
  ASSERT_TRUE(found && shuffled);
  EXPECT_LT((found->in_odometry - shuffled->in_odometry).norm(), 1e-9);
  EXPECT_LT((found->covariance - shuffled->covariance).norm(), 1e-9);
}

/// What a patch shows from beside is half a pixel off, in all later pictures alike.
TEST(LandmarkPoint, AnErrorThatLaterSightingsShareIsNotTakenForParallax) {
  const Eigen::Vector3d point(0.2, 0.1, 2);
  std::vector<PlacedSighting> seen_alike, seen_differently;
  for (int i = 0; i < 6; ++i) {
    SE3 pose = SE3::Identity();
    if (i > 0) pose.translation().x() = -0.3 - 0.01 * i;
    const StereoPixel off = i > 0 ? StereoPixel(0.5, 0, 0) : StereoPixel::Zero();
    seen_alike.push_back({pose, project(kMatchCamera, pose * point) + off});
    seen_differently.push_back({pose, seen_alike.back().pixel, i > 0 ? 1.0 : 0.0});
  }
  const auto trusting = refined(seen_alike), wary = refined(seen_differently);
  ASSERT_TRUE(trusting && wary);
  const double error_m = std::abs(wary->in_odometry.z() - point.z());
  EXPECT_LT(error_m, 0.5 * std::abs(trusting->in_odometry.z() - point.z()));
  EXPECT_LT(error_m, 3 * std::sqrt(wary->covariance(2, 2)));
}

TEST(LandmarkPoint, BehindACameraThereIsNone) {
  SE3 turned = SE3::Identity();
  turned.linear() = Eigen::AngleAxisd(3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_FALSE(refined({{SE3::Identity(), {300, 200, 20}}, {turned, {300, 200, 20}}}));
}

}  // namespace
}  // namespace flogmap
