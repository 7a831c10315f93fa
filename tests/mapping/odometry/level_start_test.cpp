#include "mapping/odometry/level_start.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "textured_room.hpp"

namespace flogmap {
namespace {

using namespace test;

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr std::int64_t kSecond = 1'000'000'000;

double tilt_error_deg(const Level& level, const SE3& true_world_from_odometry) {
  const Eigen::Vector3d up = level.world_from_odometry.linear().row(2);
  const Eigen::Vector3d true_up = true_world_from_odometry.linear().row(2);
  return std::acos(std::min(1.0, up.dot(true_up))) / kRadPerDeg;
}

/// Watches a camera that turns slowly on the spot until the start is decided.
Level watch(const SE3& first, std::optional<Eigen::Vector3d> up = std::nullopt, double yaw_rate = 0.1) {
  LevelStart start(kRoomCamera, {}, up);
  const TexturedRoom room;
  for (int i = 0;; ++i) {
    SE3 pose = first;
    pose.linear() = Eigen::AngleAxisd(yaw_rate * i, Eigen::Vector3d::UnitZ()) * first.linear();
    const auto level = start.add(i * kSecond / 2, room.render(pose).disparity, first.inverse() * pose);
    if (level) return *level;
  }
}

TEST(LevelStart, FloorGivesTiltAndHeightHoweverTheCameraIsHeld) {
  for (const double pitch_deg : {-35.0, -18.0, -8.0}) {
    for (const double roll_deg : {-18.0, 0.0, 12.0}) {
      const SE3 first = camera_at({0.3, -0.2, 1.3}, 0.4, pitch_deg * kRadPerDeg, roll_deg * kRadPerDeg);
      const Level level = watch(first);
      ASSERT_TRUE(level.tilt_known && level.height_known) << level.how;
      EXPECT_LT(tilt_error_deg(level, first), 0.3) << pitch_deg << " " << roll_deg;
      EXPECT_NEAR(level.world_from_odometry.translation().z(), 1.3, 0.01);
    }
  }
}

TEST(LevelStart, GravityIsBelievedAndTheFloorGivesTheHeight) {
  const SE3 first = camera_at({0, 0, 1.1}, 0, -20 * kRadPerDeg, 5 * kRadPerDeg);
  const Eigen::Vector3d up = first.linear().transpose() * Eigen::Vector3d::UnitZ();
  const Level level = watch(first, up);
  EXPECT_LT(tilt_error_deg(level, first), 1e-6);
  EXPECT_TRUE(level.height_known);
  EXPECT_NEAR(level.world_from_odometry.translation().z(), 1.1, 0.01);
}

TEST(LevelStart, WithoutAFloorTheOpticalAxisIsLevelAndItSaysSo) {
  const SE3 at_wall = camera_at({2.2, 0, 1.3}, 0);  // the wall 0.8 m ahead fills the view
  const Level level = watch(at_wall, std::nullopt, 0);
  EXPECT_FALSE(level.tilt_known);
  EXPECT_FALSE(level.height_known);
  EXPECT_TRUE(level.world_from_odometry.isApprox(level_of_camera()));
  EXPECT_NE(level.how.find("no floor"), std::string::npos);
}

TEST(LevelOfCamera, ForwardIsXAndRightIsMinusYAndDownIsMinusZ) {
  const SE3 world_from_camera = level_of_camera();
  EXPECT_TRUE((world_from_camera * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE((world_from_camera * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_TRUE((world_from_camera * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ()));
}

TEST(LevelFromUp, IsARotationThatTakesUpToZAndKeepsTheOpticalAxisOverX) {
  for (const Eigen::Vector3d& up :
       {Eigen::Vector3d(0.1, -0.9, -0.4), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(-0.5, -0.5, 0.2)}) {
    const SE3 world_from_odometry = level_from_up(up.normalized(), 1.5);
    EXPECT_NEAR(world_from_odometry.linear().determinant(), 1, 1e-12);
    EXPECT_TRUE((world_from_odometry.linear() * up.normalized()).isApprox(Eigen::Vector3d::UnitZ()));
    EXPECT_NEAR((world_from_odometry.linear() * Eigen::Vector3d::UnitZ()).y(), 0, 1e-12);
    EXPECT_TRUE(world_from_odometry.translation().isApprox(Eigen::Vector3d(0, 0, 1.5)));
  }
}

}  // namespace
}  // namespace flogmap
