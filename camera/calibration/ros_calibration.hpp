#pragma once

#include <string>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// Text of a file and its name, for messages.
struct CalibrationText {
  std::string text, origin;
};

/// Two camera_info files as ROS camera_calibration writes them. How the cameras stand to one another follows
/// from their rectification matrices and the baseline in the right projection matrix (P[3] = -fx baseline).
/// Throws std::runtime_error naming origin and field.
[[nodiscard]] StereoCalibration parse_ros_pair(const CalibrationText& left, const CalibrationText& right);

}  // namespace flogmap
