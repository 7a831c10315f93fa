// What a hand-held camera meets: gaps, repetitions, moving things, scenes that say little.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "walking.hpp"

namespace flogmap {
namespace {

using namespace test;

/// Largest error of a walk of which only every `every`-th frame is seen, metres; infinite if one is not
/// tracked.
double largest_error_m(int every) {
  StereoOdometry odometry({}, kRoomCamera);
  const TexturedRoom room;
  double largest_m = 0;
  for (int i = 0; i <= 24; i += every) {
    const SE3 now = hand_held(0.1 * i);
    const Tracking tracking = track(odometry, room.render(now));
    if (tracking.state != TrackingState::ok) return std::numeric_limits<double>::infinity();
    largest_m = std::max(largest_m, error_of(tracking, hand_held(0), now).first);
  }
  return largest_m;
}

TEST(OdometryRobustness, EverySecondAndEveryFourthFrameAreFollowedAsWell) {
  EXPECT_LT(largest_error_m(1), 0.01);
  EXPECT_LT(largest_error_m(2), 0.015);
  EXPECT_LT(largest_error_m(4), 0.015);
}

TEST(OdometryRobustness, ARepeatedFrameHasTheSamePoseAndChangesNothing) {
  const TexturedRoom room;
  StereoOdometry once({}, kRoomCamera), thrice({}, kRoomCamera);
  for (int i = 0; i < 8; ++i) {
    const RenderedFrame frame = room.render(hand_held(0.15 * i));
    const SE3 pose = track(once, frame).odometry_from_camera;
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Tracking tracking = track(thrice, frame);
      ASSERT_EQ(tracking.state, TrackingState::ok);
      EXPECT_LT((pose.inverse() * tracking.odometry_from_camera).translation().norm(), 0.002) << i;
    }
  }
}

TEST(OdometryRobustness, AGapInTheMiddleIsBridged) {
  const TexturedRoom room;
  StereoOdometry odometry({}, kRoomCamera);
  for (const double s : {0.0, 0.1, 0.2, 0.3, 0.9, 1.0, 1.1}) {  // 0.5 m and 14 degrees are not seen
    const Tracking tracking = track(odometry, room.render(hand_held(s)));
    ASSERT_TRUE(tracking.has_pose()) << s << ": " << tracking.reason;
    EXPECT_LT(error_of(tracking, hand_held(0), hand_held(s)).first, 0.015) << s;
  }
}

/// What `front` says in a part of the picture, else what `behind` says.
RenderedFrame in_front(const RenderedFrame& front, RenderedFrame behind, int left, int right) {
  for (int y = 0; y < behind.pair.left.height; ++y) {
    for (int x = left; x < right; ++x) {
      behind.pair.left.at(x, y) = front.pair.left.at(x, y);
      behind.pair.right.at(x, y) = front.pair.right.at(x, y);
      behind.disparity.px.at(x, y) = front.disparity.px.at(x, y);
    }
  }
  return behind;
}

TEST(OdometryRobustness, ALargeThingThatMovesByItselfDoesNotCarryTheCameraAlong) {
  const TexturedRoom room{.half_m = {1.6, 1.4, 0}, .height_m = 2.2}, lorry{.seed = 7};
  StereoOdometry odometry({}, kRoomCamera);
  const auto walking = [](int i) {
    return camera_at({-0.9 + 0.04 * i, 0.02 * i, 1.2}, 0.3 + 0.03 * i, -0.2);
  };
  const auto passing = [](int i) { return camera_at({1.2, -0.3 + 0.12 * i, 1.3}, 0); };
  for (int i = 0; i < 8; ++i) {  // a third of the picture passes by at a speed of its own
    const Tracking tracking =
        track(odometry, in_front(lorry.render(passing(i)), room.render(walking(i)), 180, 276));
    ASSERT_TRUE(tracking.has_pose()) << i << ": " << tracking.reason;
    EXPECT_LT(error_of(tracking, walking(0), walking(i)).first, 0.005) << i;
  }
}

TEST(OdometryRobustness, ALineOfPointsGivesNoPoseThatIsWrong) {
  const TexturedRoom room;
  const auto on_a_line = [](int, int y) { return std::abs(y - 120) < 6; };
  StereoOdometry odometry({}, kRoomCamera);
  for (int i = 0; i < 5; ++i) {
    const SE3 now = hand_held(0.04 * i);
    const Tracking tracking = track(odometry, masked(room.render(now), on_a_line));
    if (tracking.state != TrackingState::ok) {
      EXPECT_FALSE(tracking.reason.empty());
      continue;
    }
    EXPECT_LT(error_of(tracking, hand_held(0), now).first, 0.05) << i;
  }
}

TEST(OdometryRobustness, NoErrorIsLargerThanTheCovarianceSays) {
  const TexturedRoom room;
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  StereoOdometry odometry({}, kRoomCamera);
  (void)track(odometry, room.render(hand_held(0)));
  for (int i = 0; i < 20; ++i) {  // all seen from the first key frame, so that no errors add up
    const SE3 now = camera_at({-1.5 + 0.03 * normal(random), 0.03 * normal(random), 1.3},
                              0.02 * normal(random), 0.02 * normal(random), 0.05 * normal(random));
    const Tracking tracking = track(odometry, room.render(now));
    ASSERT_EQ(tracking.state, TrackingState::ok);
    ASSERT_FALSE(tracking.new_key_frame);
    const SE3 now_from_key = now.inverse() * hand_held(0);
    const SE3 residual = tracking.odometry_from_camera.inverse() * now_from_key.inverse();
    Eigen::Matrix<double, 6, 1> x;
    const Eigen::AngleAxisd turn(residual.linear());
    x << residual.translation(), turn.angle() * turn.axis();
    EXPECT_LT(x.dot(tracking.covariance.ldlt().solve(x)), 22.5);  // chi^2 with 6 degrees of freedom: 99.9 %
  }
}

}  // namespace
}  // namespace flogmap
