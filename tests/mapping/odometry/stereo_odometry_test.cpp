#include "mapping/odometry/stereo_odometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include "walking.hpp"

namespace flogmap {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

TEST(StereoOdometry, FirstFrameIsTheOrigin) {
  StereoOdometry odometry({}, kRoomCamera);
  const Tracking first = track(odometry, TexturedRoom{}.render(hand_held(0)));
  EXPECT_EQ(first.state, TrackingState::ok);
  EXPECT_TRUE(first.new_key_frame);
  EXPECT_EQ(first.odometry_from_camera.matrix(), SE3::Identity().matrix());
}

TEST(StereoOdometry, KnownMotionIsRecoveredWithinAFewMillimetres) {
  StereoOdometry odometry({}, kRoomCamera);
  const TexturedRoom room;
  for (int i = 0; i <= 25; ++i) {
    const SE3 now = hand_held(0.1 * i);
    const Tracking tracking = track(odometry, room.render(now));
    ASSERT_EQ(tracking.state, TrackingState::ok) << i << ": " << tracking.reason;
    const auto [metres, degrees] = error_of(tracking, hand_held(0), now);
    EXPECT_LT(metres, 0.01) << i;
    EXPECT_LT(degrees, 0.2) << i;
  }
}

TEST(StereoOdometry, StillCameraDoesNotDrift) {
  StereoOdometry odometry({}, kRoomCamera);
  const RenderedFrame frame = TexturedRoom{}.render(hand_held(0.7));
  (void)track(odometry, frame);
  for (int i = 0; i < 300; ++i) {
    const Tracking tracking = track(odometry, frame);
    ASSERT_EQ(tracking.state, TrackingState::ok);
    ASSERT_FALSE(tracking.new_key_frame);
    ASSERT_LT(tracking.odometry_from_camera.translation().norm(), 2e-4);
  }
}

TEST(StereoOdometry, SameFramesGiveTheSameBits) {
  const TexturedRoom room;
  StereoOdometry one({}, kRoomCamera), other({}, kRoomCamera);
  (void)track(other, room.render(camera_at({1, 1, 1}, 2)));
  other.reset();
  for (int i = 0; i < 8; ++i) {
    const RenderedFrame frame = room.render(hand_held(0.15 * i));
    const Tracking a = track(one, frame), b = track(other, frame);
    EXPECT_EQ(a.odometry_from_camera.matrix(), b.odometry_from_camera.matrix());
    EXPECT_EQ(a.covariance, b.covariance);
  }
}

TEST(StereoOdometry, HalfRollBetweenTwoFramesIsFollowed) {
  const TexturedRoom room;
  for (const double roll : {kPi / 2, kPi, -2.5}) {
    StereoOdometry odometry({}, kRoomCamera);
    const SE3 first = camera_at({-1, 0, 1.3}, 0), rolled = camera_at({-0.9, 0.05, 1.3}, 0.05, 0, roll);
    (void)track(odometry, room.render(first));
    const Tracking tracking = track(odometry, room.render(rolled));
    ASSERT_TRUE(tracking.has_pose()) << roll << ": " << tracking.reason;
    const auto [metres, degrees] = error_of(tracking, first, rolled);
    EXPECT_LT(metres, 0.01) << roll;
    EXPECT_LT(degrees, 0.3) << roll;
  }
}

TEST(StereoOdometry, HalfOverlapIsEnough) {
  const TexturedRoom room;
  StereoOdometry odometry({}, kRoomCamera);
  const double half_view = std::atan(160.0 / 250);
  const SE3 first = camera_at({0, 0, 1.3}, 0), turned = camera_at({0, 0.1, 1.3}, half_view);
  (void)track(odometry, room.render(first));
  const Tracking tracking = track(odometry, room.render(turned));
  ASSERT_TRUE(tracking.has_pose()) << tracking.reason;
  const auto [metres, degrees] = error_of(tracking, first, turned);
  EXPECT_LT(metres, 0.02);
  EXPECT_LT(degrees, 0.3);
}

TEST(StereoOdometry, CoveredLensIsLostAtOnceAndFoundAgainWhereItIs) {
  const TexturedRoom room;
  StereoOdometry odometry({}, kRoomCamera);
  for (int i = 0; i < 5; ++i) (void)track(odometry, room.render(hand_held(0.1 * i)));
  for (int i = 0; i < 20; ++i) {
    const Tracking dark = track(odometry, plain_frame(4));
    ASSERT_EQ(dark.state, TrackingState::lost);
    EXPECT_THAT(dark.reason, HasSubstr("dark"));
  }
  const SE3 now = hand_held(0.8);
  const Tracking found = track(odometry, room.render(now));
  ASSERT_TRUE(found.has_pose()) << found.reason;
  EXPECT_LT(error_of(found, hand_held(0), now).first, 0.02);
}

TEST(StereoOdometry, PutDownElsewhereGoesOnFromTheLastKnownPoseAndSaysSo) {
  StereoOdometry odometry({}, kRoomCamera);
  const TexturedRoom room{.seed = 1}, elsewhere{.seed = 2};
  Tracking last;
  for (int i = 0; i < 3; ++i) last = track(odometry, room.render(hand_held(0.1 * i)));
  Tracking tracking;
  int num_lost = 0;
  for (int i = 0; i < 20; ++i) {
    tracking = track(odometry, elsewhere.render(camera_at({0, 0, 1.3}, 2)));
    if (tracking.has_pose()) break;
    ++num_lost;
    EXPECT_FALSE(tracking.reason.empty());
  }
  EXPECT_EQ(num_lost, OdometryOptions{}.max_lost_frames);
  EXPECT_EQ(tracking.state, TrackingState::weak);
  EXPECT_EQ(tracking.segment, 1);
  EXPECT_THAT(tracking.reason, HasSubstr("last known pose"));
  EXPECT_EQ(tracking.odometry_from_camera.matrix(), last.odometry_from_camera.matrix());
}

TEST(StereoOdometry, PlainSurfacesAreNeverGivenAPose) {
  StereoOdometry odometry({}, kRoomCamera);
  const TexturedRoom plain{.contrast = 0};
  for (int i = 0; i < 5; ++i) {
    const Tracking tracking = track(odometry, plain.render(hand_held(0.1 * i)));
    EXPECT_EQ(tracking.state, TrackingState::initialising);
    EXPECT_THAT(tracking.reason, HasSubstr("too few corners"));
  }
}

TEST(StereoOdometry, SwappedPicturesAreNoticed) {
  StereoOdometry odometry({}, kRoomCamera);
  RenderedFrame frame = TexturedRoom{}.render(hand_held(0));
  std::swap(frame.pair.left, frame.pair.right);
  for (float& d : frame.disparity.px.pixels) d = std::numeric_limits<float>::quiet_NaN();  // nothing matches
  const Tracking tracking = track(odometry, frame);
  EXPECT_FALSE(tracking.has_pose());
  EXPECT_THAT(tracking.reason, HasSubstr("swapped"));
}

TEST(StereoOdometry, FarPointsOnlyGiveNoPoseThatIsWrong) {
  const TexturedRoom hall{.half_m = {60, 60, 0}, .height_m = 60, .feature_size_m = 2};
  StereoOdometry odometry({}, kRoomCamera);
  const auto pose = [](int i) { return camera_at({0.1 * i, 0, 30}, 0); };
  (void)track(odometry, hall.render(pose(0)));
  for (int i = 1; i < 4; ++i) {
    const Tracking tracking = track(odometry, hall.render(pose(i)));  // 60 m away at a baseline of 0.12 m
    if (tracking.state != TrackingState::ok) continue;
    EXPECT_LT(error_of(tracking, pose(0), pose(i)).first, 0.15) << i;
  }
}

TEST(StereoOdometry, AFewBunchedPointsGiveNoPose) {
  const TexturedRoom room;
  const auto in_a_bunch = [](int x, int y) { return std::abs(x - 160) < 16 && std::abs(y - 120) < 16; };
  StereoOdometry odometry({}, kRoomCamera);
  (void)track(odometry, room.render(hand_held(0)));
  const Tracking tracking = track(odometry, masked(room.render(hand_held(0.02)), in_a_bunch));
  EXPECT_EQ(tracking.state, TrackingState::lost);
  EXPECT_FALSE(tracking.reason.empty());
}

TEST(StereoOdometry, OneTexturedWallIsEnough) {
  const TexturedRoom room;
  StereoOdometry odometry({}, kRoomCamera);
  const auto at_wall = [](int i) { return camera_at({1.6, 0.02 * i, 1.3}, 0, 0, 0.01 * i); };
  for (int i = 0; i < 6; ++i) {
    const Tracking tracking = track(odometry, room.render(at_wall(i)));
    ASSERT_TRUE(tracking.has_pose()) << tracking.reason;
    EXPECT_LT(error_of(tracking, at_wall(0), at_wall(i)).first, 0.01);
  }
}

TEST(StereoOdometry, WrongDisparityIsNotBelieved) {
  const TexturedRoom room;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(1, 60);
  StereoOdometry odometry({}, kRoomCamera);
  for (int i = 0; i < 6; ++i) {
    RenderedFrame frame = room.render(hand_held(0.1 * i));
    for (float& d : frame.disparity.px.pixels) {
      if (random() % 2 == 0) d = any(random);
    }
    const Tracking tracking = track(odometry, frame);
    ASSERT_TRUE(tracking.has_pose()) << i << ": " << tracking.reason;
    EXPECT_LT(error_of(tracking, hand_held(0), hand_held(0.1 * i)).first, 0.02) << i;
  }
}

TEST(StereoOdometry, MatchesLieInThePictureAndInliersAreAmongThem) {
  const TexturedRoom room;
  StereoOdometry odometry({}, kRoomCamera);
  (void)track(odometry, room.render(hand_held(0)));
  const Tracking tracking = track(odometry, room.render(hand_held(0.05)));
  EXPECT_GT(std::count_if(tracking.matches.begin(), tracking.matches.end(),
                          [](const Match& m) { return m.inlier; }),
            50);
  const Image<std::uint8_t> picture(kRoomCamera.width_px, kRoomCamera.height_px);
  for (const Match& match : tracking.matches) {
    EXPECT_TRUE(
        picture.contains(static_cast<int>(match.current_px.x()), static_cast<int>(match.current_px.y())));
    EXPECT_GT(match.current_disparity_px, 0);
  }
}

TEST(StereoOdometry, ImpossibleCamerasAndOptionsAreNamed) {
  StereoCamera flat = kRoomCamera;
  flat.baseline_m = 0;
  EXPECT_THROW(StereoOdometry({}, flat), std::runtime_error);
  OdometryOptions options;
  options.key_frame_overlap = 1.5;
  try {
    StereoOdometry odometry(options, kRoomCamera);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("key_frame_overlap"));
  }
}

}  // namespace
}  // namespace flogmap
