// Every reason for a frame without a pose, reached as it happens: by pictures.
#include "mapping/odometry/lost_reasons.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "walking.hpp"

namespace flogmap {
namespace {

using namespace test;
using testing::HasSubstr;

/// What the odometry says of a frame after three good ones.
std::string reason_after_a_walk(const RenderedFrame& frame) {
  StereoOdometry odometry({}, kRoomCamera);
  const TexturedRoom room;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(track(odometry, room.render(hand_held(0.1 * i))).has_pose());
  const Tracking tracking = track(odometry, frame);
  EXPECT_EQ(tracking.state, TrackingState::lost);
  return tracking.reason;
}

/// Every pixel the mean of `length_px` along its row, as while the camera turns.
void blur_rows(Image<std::uint8_t>& image, int length_px) {
  const Image<std::uint8_t> sharp = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      int sum = 0;
      for (int u = 0; u < length_px; ++u) sum += sharp.at((x + u) % image.width, y);
      image.at(x, y) = static_cast<std::uint8_t>(sum / length_px);
    }
  }
}

/// The same things, each somewhere else: small blocks of the picture change places.
RenderedFrame rearranged(const RenderedFrame& frame) {
  constexpr int kBlockPx = 40;
  const int columns = frame.pair.left.width / kBlockPx,
            num_blocks = columns * frame.pair.left.height / kBlockPx;
  std::vector<int> from(num_blocks);
  for (int i = 0; i < num_blocks; ++i) from[i] = i;
  std::shuffle(from.begin(), from.end(), std::mt19937(5));
  RenderedFrame moved = frame;
  for (int i = 0; i < num_blocks; ++i) {
    for (int y = 0; y < kBlockPx; ++y) {
      for (int x = 0; x < kBlockPx; ++x) {
        const int to_x = i % columns * kBlockPx + x, to_y = i / columns * kBlockPx + y;
        const int from_x = from[i] % columns * kBlockPx + x, from_y = from[i] / columns * kBlockPx + y;
        moved.pair.left.at(to_x, to_y) = frame.pair.left.at(from_x, from_y);
        moved.disparity.px.at(to_x, to_y) = frame.disparity.px.at(from_x, from_y);
      }
    }
  }
  return moved;
}

TEST(LostReasons, TooFewCorners) {
  StereoOdometry odometry({}, kRoomCamera);
  const auto corner_of_picture = [](int x, int y) { return x < 60 && y < 50; };
  const Tracking tracking = track(odometry, masked(TexturedRoom{}.render(hand_held(0)), corner_of_picture));
  EXPECT_EQ(tracking.state, TrackingState::initialising);
  EXPECT_THAT(tracking.reason, HasSubstr("too few corners ("));
}

TEST(LostReasons, TooDark) { EXPECT_THAT(reason_after_a_walk(plain_frame(4)), HasSubstr("too dark")); }

TEST(LostReasons, Blocked) { EXPECT_THAT(reason_after_a_walk(plain_frame(130)), HasSubstr("blocked")); }

TEST(LostReasons, TooFastForASharpPicture) {
  RenderedFrame frame = TexturedRoom{}.render(hand_held(0.3));
  blur_rows(frame.pair.left, 150);
  blur_rows(frame.pair.right, 150);
  for (int x = 0; x < kRoomCamera.width_px; ++x) {  // a bright window stays bright
    for (int y = 0; y < 100; ++y) frame.pair.left.at(x, y) = frame.pair.right.at(x, y) = 250;
  }
  EXPECT_THAT(reason_after_a_walk(frame), HasSubstr("too fast"));
}

TEST(LostReasons, TooFastToSeeAnythingAgain) {
  const TexturedRoom room;
  EXPECT_THAT(reason_after_a_walk(room.render(camera_at({-1, 0, 1.3}, std::numbers::pi))),
              HasSubstr("too fast, or somewhere else"));
}

TEST(LostReasons, TheSceneHasMoved) {
  EXPECT_THAT(reason_after_a_walk(rearranged(TexturedRoom{}.render(hand_held(0.2)))),
              HasSubstr("the scene has moved"));
}

}  // namespace
}  // namespace flogmap
