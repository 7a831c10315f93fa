// What the tests of the odometry walk through, and what may go wrong with a picture.
#pragma once

#include <limits>
#include <utility>

#include "mapping/odometry/stereo_odometry.hpp"
#include "textured_room.hpp"

namespace flogmap::test {

inline Tracking track(StereoOdometry& odometry, const RenderedFrame& frame) {
  return odometry.track(frame.pair, frame.disparity);
}

/// A walk along an arc, as by hand: turns, nods and rolls.
inline SE3 hand_held(double s) {
  return camera_at({-1.5 + 0.8 * s, 0.3 * std::sin(2 * s), 1.3 + 0.05 * std::sin(5 * s)}, 0.4 * s,
                   0.1 * std::sin(3 * s), 0.15 * std::sin(4 * s));
}

/// Error of the tracked pose, metres and degrees.
inline std::pair<double, double> error_of(const Tracking& tracking, const SE3& first, const SE3& now) {
  const SE3 error = (first.inverse() * now).inverse() * tracking.odometry_from_camera;
  return {error.translation().norm(), angle_deg(error)};
}

/// Of one grey, nothing matches.
inline RenderedFrame plain_frame(std::uint8_t grey) {
  RenderedFrame frame;
  frame.pair.left = frame.pair.right = Image<std::uint8_t>(kRoomCamera.width_px, kRoomCamera.height_px, grey);
  frame.disparity.px =
      Image<float>(kRoomCamera.width_px, kRoomCamera.height_px, std::numeric_limits<float>::quiet_NaN());
  return frame;
}

/// Only what `keep` says is textured; the rest of the picture is plain.
template <typename Keep>
RenderedFrame masked(RenderedFrame frame, Keep keep) {
  for (int y = 0; y < frame.pair.left.height; ++y) {
    for (int x = 0; x < frame.pair.left.width; ++x) {
      if (keep(x, y)) continue;
      frame.pair.left.at(x, y) = frame.pair.right.at(x, y) = 120;
      frame.disparity.px.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return frame;
}

}  // namespace flogmap::test
