#include "mapping/odometry/motion_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "synthetic_matches.hpp"

namespace flogmap {
namespace {

using namespace test;

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The twist x with small_motion(x) = motion.
Vector6 twist_of(const SE3& motion) {
  const Eigen::AngleAxisd turn(motion.linear());
  Vector6 x;
  x << motion.translation(), turn.angle() * turn.axis();
  return x;
}

std::vector<PointPair> exact_pairs(std::mt19937& random, const SE3& motion, int count) {
  return synthetic_matches(random, motion, count, 0, 0).pairs;
}

TEST(ClosedForm, RecoversAnExactMotionWhateverTheWeights) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> weight(0.1, 10);
  for (int trial = 0; trial < 200; ++trial) {
    const SE3 motion = random_motion(random, 2, 0.015 * trial);
    const auto pairs = exact_pairs(random, motion, 3 + trial % 20);
    std::vector<double> weights;
    for (std::size_t i = 0; i < pairs.size(); ++i) weights.push_back(weight(random));
    const auto found = align_points(pairs, weights);
    ASSERT_TRUE(found);
    EXPECT_LT((found->matrix() - motion.matrix()).norm(), 1e-8);
  }
}

TEST(ClosedForm, RefusesPointsOnALineAndFewerThanThree) {
  std::vector<PointPair> line;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d p(0.1 * i, 0.2 * i, 3 + 0.05 * i);
    line.push_back({p, p + Eigen::Vector3d(0.1, 0, 0)});
  }
  EXPECT_FALSE(align_points(line, std::vector<double>(line.size(), 1)));
  std::mt19937 random(2);
  EXPECT_FALSE(align_points(exact_pairs(random, SE3::Identity(), 2), {1, 1}));
}

/// Points as the key frame measures them, and where the current frame sees them.
std::vector<MotionPoint> noisy_points(std::mt19937& random, const SE3& current_from_key, int count,
                                      double sigma_px, double near_m, double far_m) {
  std::normal_distribution<double> noise(0, sigma_px);
  const auto disturb = [&](const StereoPixel& s) {
    return StereoPixel(s + StereoPixel(noise(random), noise(random), noise(random)));
  };
  std::vector<MotionPoint> points;
  while (static_cast<int>(points.size()) < count) {
    const Eigen::Vector3d p = random_point(random, near_m, far_m), q = current_from_key * p;
    if (q.z() < 0.3) continue;
    const StereoPixel key = disturb(project(kMatchCamera, p));
    const Eigen::Matrix3d J = triangulate_jacobian(kMatchCamera, key);
    points.push_back({triangulate(kMatchCamera, key), sigma_px * sigma_px * J * J.transpose(),
                      disturb(project(kMatchCamera, q))});
  }
  return points;
}

MotionOptions with_noise(double sigma_px) {
  MotionOptions options;
  options.image_sigma_px = options.disparity_sigma_px = sigma_px;
  return options;
}

TEST(RefinedMotion, ErrorIsWhatTheCovarianceSays) {
  std::mt19937 random(4);
  constexpr int kTrials = 300;
  double sum = 0;  // normalised estimation error squared: chi^2 with 6 degrees of freedom, mean 6
  for (int trial = 0; trial < kTrials; ++trial) {
    const SE3 motion = random_motion(random, 0.3, 0.15);
    const auto points = noisy_points(random, motion, 60, 0.1, 1, 4);
    const auto found = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.1));
    ASSERT_TRUE(found);
    const Vector6 error = twist_of(found->current_from_key * motion.inverse());
    sum += error.dot(found->covariance.ldlt().solve(error));
  }
  // The mean of 300 such numbers has a standard deviation of sqrt(12 / 300) = 0.2. The covariance is never
  // made smaller than promised but is enlarged for the lower weights and where residuals are large.
  EXPECT_GT(sum / kTrials, 4.8);
  EXPECT_LT(sum / kTrials, 6.6);
}

TEST(RefinedMotion, IsNotBentByWrongPoints) {
  std::mt19937 random(6);
  const SE3 motion = random_motion(random, 0.3, 0.1);
  auto points = noisy_points(random, motion, 80, 0.1, 1, 4);
  const auto clean = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.1));
  std::uniform_real_distribution<double> off(-40, 40);
  for (int i = 0; i < 20; ++i) points[i].current += StereoPixel(off(random), off(random), off(random) / 10);
  const auto found = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.1));
  ASSERT_TRUE(clean && found);
  EXPECT_LT((found->current_from_key.matrix() - clean->current_from_key.matrix()).norm(), 0.005);
  EXPECT_GE(found->num_inliers, 55);
  EXPECT_EQ(std::count(found->inlier.begin(), found->inlier.end(), true), found->num_inliers);
}

TEST(RefinedMotion, FarPointsOnlyLeaveTheTranslationUncertainAndSaySo) {
  std::mt19937 random(8);
  const SE3 motion = random_motion(random, 0.1, 0.05);
  const auto far = refine_motion(kMatchCamera, noisy_points(random, motion, 80, 0.1, 40, 60), SE3::Identity(),
                                 with_noise(0.1));
  const auto near = refine_motion(kMatchCamera, noisy_points(random, motion, 80, 0.1, 1, 3), SE3::Identity(),
                                  with_noise(0.1));
  ASSERT_TRUE(far && near);
  const auto uncertainty = [](const Motion& m) { return m.covariance.diagonal().head(3).sum(); };
  EXPECT_GT(uncertainty(*far), 100 * uncertainty(*near));
}

/// One point in four is half a pixel off, within the bounds of an inlier.
TEST(RefinedMotion, ManySmallErrorsDecideAgainstSomeLargeOnes) {
  std::mt19937 random(18);
  double with_all = 0, with_good = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 motion = random_motion(random, 0.3, 0.1);
    auto points = noisy_points(random, motion, 60, 0.03, 1, 4);
    const auto good = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.15));
    for (const auto& coarse : noisy_points(random, motion, 20, 0.5, 1, 4)) points.push_back(coarse);
    for (std::size_t i = 60; i < points.size(); ++i) points[i].covariance *= 0.01;
    const auto all = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.15));
    ASSERT_TRUE(good && all);
    with_good += twist_of(good->current_from_key * motion.inverse()).squaredNorm();
    with_all += twist_of(all->current_from_key * motion.inverse()).squaredNorm();
  }
  EXPECT_LT(std::sqrt(with_all / with_good), 1.05);  // 1.13 with Huber's loss
}

TEST(RefinedMotion, SurfacesThatLookDifferentSayLess) {
  std::mt19937 random(20);
  const SE3 motion = random_motion(random, 0.3, 0.1);
  auto points = noisy_points(random, motion, 60, 0.1, 1, 4);
  const auto alike = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.1));
  for (MotionPoint& point : points) point.view_change = 1;
  const auto different = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.1));
  ASSERT_TRUE(alike && different);
  EXPECT_GT(different->covariance.trace(), 1.3 * alike->covariance.trace());
}

/// A wall far away, and `num_near` points close by.
std::vector<MotionPoint> far_wall_and_near(std::mt19937& random, const SE3& motion, int num_near) {
  auto points = noisy_points(random, motion, 40, 0.1, 20, 22);
  for (const auto& point : noisy_points(random, motion, num_near, 0.1, 1, 1.1)) points.push_back(point);
  return points;
}

TEST(RefinedMotion, OneWrongPointThatNothingContradictsDoesNotDecide) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> off(-3, 3);
  constexpr int kTrials = 100;
  double sum = 0;  // as above; if the wrong point decides, the mean is above 50
  for (int trial = 0; trial < kTrials; ++trial) {
    const SE3 motion = random_motion(random, 0.05, 0.02);
    auto points = far_wall_and_near(random, motion, 1);
    points.back().current += StereoPixel(off(random), off(random), off(random));
    const auto found = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.1));
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->inlier.back());
    const Vector6 error = twist_of(found->current_from_key * motion.inverse());
    sum += error.dot(found->covariance.ldlt().solve(error));
  }
  EXPECT_LT(sum / kTrials, 7.1);  // 6 and three times sqrt(12 / 100)
}

TEST(RefinedMotion, NearPointsThatAgreeAreBelieved) {
  std::mt19937 random(16);
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 motion = random_motion(random, 0.05, 0.02);
    const auto points = far_wall_and_near(random, motion, 20);
    const auto found = refine_motion(kMatchCamera, points, SE3::Identity(), with_noise(0.1));
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->with_decisive);
    EXPECT_GE(found->num_inliers, 57);
  }
}

TEST(RefinedMotion, RefusesTooFewPoints) {
  std::mt19937 random(10);
  EXPECT_FALSE(
      refine_motion(kMatchCamera, noisy_points(random, SE3::Identity(), 2, 0.1, 1, 4), SE3::Identity(), {}));
}

TEST(SmallMotion, TurnsByTheLengthOfTheVector) {
  Vector6 x;
  x << 1, 2, 3, 0, 0, 0.5;
  const SE3 motion = small_motion(x);
  EXPECT_NEAR(Eigen::AngleAxisd(motion.linear()).angle(), 0.5, 1e-12);
  EXPECT_EQ(motion.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(small_motion(Vector6::Zero()).isApprox(SE3::Identity()));
}

}  // namespace
}  // namespace flogmap
