#include "mapping/given_poses.hpp"

#include <gtest/gtest.h>

namespace flogmap {
namespace {

constexpr std::int64_t kMs = 1'000'000;

SE3 at_x(double x_m) {
  SE3 pose = SE3::Identity();
  pose.translation().x() = x_m;
  return pose;
}

TEST(GivenPoses, TheNearestInTimeIsTakenWithinFiveMilliseconds) {
  const GivenPoses poses({{100 * kMs, at_x(1)}, {108 * kMs, at_x(2)}}, SE3::Identity());
  EXPECT_EQ(poses.at(100 * kMs)->translation().x(), 1);
  EXPECT_EQ(poses.at(103 * kMs)->translation().x(), 1);
  EXPECT_EQ(poses.at(105 * kMs)->translation().x(), 2);
  EXPECT_EQ(poses.at(113 * kMs)->translation().x(), 2);
  EXPECT_EQ(poses.at(95 * kMs)->translation().x(), 1);
  EXPECT_FALSE(poses.at(95 * kMs - 1));
  EXPECT_FALSE(poses.at(113 * kMs + 1));
}

TEST(GivenPoses, NoPosesGiveNone) { EXPECT_FALSE(GivenPoses({}, SE3::Identity()).at(0)); }

TEST(GivenPoses, TheRectifiedCameraIsReachedThroughTheGivenFrame) {
  SE3 body_from_camera = SE3::Identity();
  body_from_camera.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  body_from_camera.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  const GivenPoses poses({{0, at_x(1)}}, body_from_camera);
  EXPECT_TRUE(poses.at(0)->isApprox(at_x(1) * body_from_camera));
}

}  // namespace
}  // namespace flogmap
