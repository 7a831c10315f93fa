#include "mapping/loop/path_correction.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "mapping/loop/corrected_path.hpp"

namespace flogmap {
namespace {

SE3 moved(double x_m, double yaw_rad = 0) {
  SE3 motion = SE3::Identity();
  motion.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.translation().x() = x_m;
  return motion;
}

const PathCorrection kTwoSegments({{100, 0, moved(1)}, {200, 0, moved(3, 0.2)}, {500, 2, moved(7)}});

TEST(PathCorrection, OnlyTheFirstSegmentHasAPlaceWithoutKnots) {
  EXPECT_TRUE(PathCorrection().map_from_odometry(5, 0)->isApprox(SE3::Identity()));
  EXPECT_FALSE(PathCorrection().map_from_odometry(5, 1));
  EXPECT_FALSE(kTwoSegments.map_from_odometry(300, 1));
}

TEST(PathCorrection, KnotsAreMetExactlyAndHoldBeyondTheEnds) {
  EXPECT_TRUE(kTwoSegments.map_from_odometry(100, 0)->matrix() == moved(1).matrix());
  EXPECT_TRUE(kTwoSegments.map_from_odometry(200, 0)->matrix() == moved(3, 0.2).matrix());
  EXPECT_TRUE(kTwoSegments.map_from_odometry(0, 0)->isApprox(moved(1)));
  EXPECT_TRUE(kTwoSegments.map_from_odometry(900, 0)->isApprox(moved(3, 0.2)));
  EXPECT_TRUE(kTwoSegments.map_from_odometry(400, 2)->isApprox(moved(7)));
  EXPECT_TRUE(kTwoSegments.map_from_odometry(900, 2)->isApprox(moved(7)));
}

TEST(PathCorrection, BetweenKnotsItGoesEvenly) {
  EXPECT_TRUE(kTwoSegments.map_from_odometry(150, 0)->isApprox(moved(2, 0.1), 1e-12));
  EXPECT_TRUE(kTwoSegments.map_from_odometry(125, 0)->isApprox(moved(1.5, 0.05), 1e-12));
}

TEST(CorrectedPath, FramesWithoutAPlaceAppearWhenTheirSegmentIsJoined) {
  CorrectedPath path({{50, moved(-1), TrackingState::ok, true}});
  const auto shown = path.add({{100, moved(0), TrackingState::ok, true, 0},
                               {300, moved(0), TrackingState::ok, true, 1},
                               {500, moved(0), TrackingState::ok, false, 2}});
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(path.num_unplaced(), 2U);
  path.correct(kTwoSegments);
  EXPECT_EQ(path.num_unplaced(), 1U);
  const auto all = path.corrected();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_TRUE(all[0].world_from_camera.isApprox(moved(-1))) << "an earlier path stays as it is";
  EXPECT_TRUE(all[1].world_from_camera.isApprox(moved(1)));
  EXPECT_TRUE(all[2].world_from_camera.isApprox(moved(7)));
}

}  // namespace
}  // namespace flogmap
