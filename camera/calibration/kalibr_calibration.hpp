#pragma once

#include <string>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// A Kalibr camchain: cam0 and cam1 with intrinsics, distortion and T_cn_cnm1; T_cam_imu if present.
/// Throws std::runtime_error naming origin and field.
[[nodiscard]] StereoCalibration parse_kalibr(const std::string& text, const std::string& origin);

}  // namespace flogmap
