// A walk around a room that comes back to where it began, and the same walk as bad odometry has it.
#pragma once

#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "mapping/flog/flog_options.hpp"
#include "tests/mapping/odometry/textured_room.hpp"
#include "tests/support/memory_source.hpp"

namespace flogmap {

inline constexpr std::int64_t kStep_ns = 500'000'000;
inline constexpr int kRound = 36, kRepeated = 5;  // frames

inline Picture picture_of(const Image<std::uint8_t>& grey) {
  return {.width = grey.width, .height = grey.height, .channels = 1, .bits = 8, .bytes = grey.pixels};
}

inline StereoCalibration room_calibration() {
  CameraIntrinsics camera{.width_px = test::kRoomCamera.width_px,
                          .height_px = test::kRoomCamera.height_px,
                          .fx_px = test::kRoomCamera.focal_px,
                          .fy_px = test::kRoomCamera.focal_px,
                          .cx_px = test::kRoomCamera.cx_px,
                          .cy_px = test::kRoomCamera.cy_px,
                          .distortion = Distortion::none,
                          .coefficients = {}};
  StereoCalibration calibration;
  calibration.left = calibration.right = camera;
  calibration.right_from_left.translation().x() = -test::kRoomCamera.baseline_m;
  calibration.rectified = true;
  return calibration;
}

/// Once around in the room and a bit further, and the same way as bad odometry has it.
struct RoundTrip {
  std::shared_ptr<RecordedFrames> recorded = std::make_shared<RecordedFrames>();
  std::vector<SE3> truth;
  std::map<std::int64_t, SE3> odometry;
};

inline const RoundTrip& round_trip() {
  static const RoundTrip made = [] {
    RoundTrip trip;
    const test::TexturedRoom room;
    SE3 error = SE3::Identity();
    error.linear() = Eigen::AngleAxisd(0.002, Eigen::Vector3d::UnitY()).toRotationMatrix();
    error.translation() = Eigen::Vector3d(0.001, 0.0005, 0.003);
    trip.recorded->calibration = room_calibration();
    for (int i = 0; i < kRound + kRepeated; ++i) {
      const double angle = 2 * std::numbers::pi * i / kRound;
      trip.truth.push_back(test::camera_at({0.6 * std::sin(angle), -0.6 * std::cos(angle), 1.3}, angle));
      const RectifiedFrame pair = room.render(trip.truth.back()).pair;
      trip.recorded->frames.push_back({i * kStep_ns, picture_of(pair.left), picture_of(pair.right)});
      const SE3 last = i == 0 ? trip.truth[0] : trip.odometry.at((i - 1) * kStep_ns);
      trip.odometry[i * kStep_ns] =
          i == 0 ? last : last * trip.truth[i - 1].inverse() * trip.truth[i] * error;
    }
    return trip;
  }();
  return made;
}

inline FlogOptions coarse_map(int num_threads) {
  FlogOptions options;
  options.grid.cell_size_m = 0.05;
  options.num_threads = num_threads;
  return options;
}

}  // namespace flogmap
