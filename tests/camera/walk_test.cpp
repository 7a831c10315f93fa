#include "camera/simulation/walk.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "tests/camera/small_scene.hpp"

namespace flogmap {
namespace {

Walk small_walk(double tremor) {
  Path path = testing::small_scene().path;
  path.tremor_m *= tremor;
  path.tremor_rad *= tremor;
  return {path, 10, 3};
}

TEST(Walk, KeepsItsSpeedEverywhere) {
  const Walk walk = small_walk(0);
  for (double t = 0; t < 2 * walk.round_s(); t += 0.31) {
    const double moved = (walk.pose(t + 0.05).translation() - walk.pose(t).translation()).norm();
    EXPECT_NEAR(moved / 0.05, 0.4, 0.01) << t;
  }
}

TEST(Walk, AClosedWalkComesBackAndGoesOn) {
  const Walk walk = small_walk(0);
  for (double t = 0; t < walk.round_s(); t += 0.7) {
    EXPECT_TRUE(walk.pose(t).isApprox(walk.pose(t + 3 * walk.round_s()), 1e-6)) << t;
  }
}

TEST(Walk, AHandShakesButNeverJumps) {
  const Walk walk = small_walk(1);
  double largest_m = 0, largest_rad = 0, off = 0;
  const Walk steady = small_walk(0);
  for (double t = 0; t < 60; t += 0.02) {
    const Eigen::Isometry3d a = walk.pose(t), b = walk.pose(t + 0.02);
    largest_m = std::max(largest_m, (b.translation() - a.translation()).norm());
    largest_rad = std::max(largest_rad, Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle());
    off = std::max(off, (a.translation() - steady.pose(t).translation()).norm());
  }
  EXPECT_LT(largest_m, 0.012);  // 0.6 m/s
  EXPECT_LT(largest_rad, 0.05);
  EXPECT_GT(off, 0.004);
  EXPECT_LT(off, 0.03);
}

TEST(Walk, TheCameraStandsUprightUpToItsRoll) {
  const Walk walk = small_walk(0);
  for (double t = 0; t < walk.round_s(); t += 0.5) {
    const Eigen::Matrix3d axes = walk.pose(t).linear();
    EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
    EXPECT_LT(axes(2, 1), -0.8);                                     // y of the camera points down
    EXPECT_LT(std::abs(axes(2, 0)), std::sin(8.1 * 3.14159 / 180));  // rolled by at most 8 degrees
  }
}

TEST(Walk, InStepsItStandsAtEveryPoint) {
  Path path = testing::small_scene().path;
  path.steps = true;
  path.tremor_m = path.tremor_rad = 0;
  const Walk walk(path, 2, 1);
  EXPECT_DOUBLE_EQ(walk.round_s(), 2.0);
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE(walk.pose(i / 2.0).translation().isApprox(path.points[i % 4].position_m)) << i;
  }
}

TEST(Walk, RefusesAPathThatLeadsNowhere) {
  Path path = testing::small_scene().path;
  path.points.resize(2);
  EXPECT_THROW(Walk(path, 10, 1), std::runtime_error);
}

}  // namespace
}  // namespace flogmap
