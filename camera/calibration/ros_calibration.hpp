#pragma once

#include <string>
#include <vector>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// Text of a file and its name, for messages.
struct CalibrationText {
  std::string text, origin;
};

/// One camera as sensor_msgs/CameraInfo and camera_info files describe it; matrices row by row.
struct RosCameraInfo {
  std::string origin;  // for messages
  double width_px = 0, height_px = 0;
  std::string distortion_model;
  std::vector<double> distortion_coefficients;  // D
  std::vector<double> camera_matrix;            // K, 3x3, of the raw pictures
  std::vector<double> rectification_matrix;     // R, 3x3
  std::vector<double> projection_matrix;        // P, 3x4, of the rectified pictures
};

/// Two camera_info files as ROS camera_calibration writes them. How the cameras stand to one another follows
/// from their rectification matrices and the baseline in the right projection matrix (P[3] = -fx baseline).
/// Throws std::runtime_error naming origin and field.
[[nodiscard]] StereoCalibration parse_ros_pair(const CalibrationText& left, const CalibrationText& right);

/// The same of two messages. With `rectified`, for pictures that are: the projection matrices alone, no lens.
[[nodiscard]] StereoCalibration ros_calibration(const RosCameraInfo& left, const RosCameraInfo& right,
                                                bool rectified);

}  // namespace flogmap
