#pragma once

#include <string>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// The result of OpenCV's stereoCalibrate as its FileStorage writes it, YAML or XML: camera matrices (M1, K1,
/// cameraMatrix1, ...), distortions (D1, distCoeffs1, ...), R, T in metres and the picture size (image_width
/// and image_height, or size). A field distortion_model: fisheye tells four fisheye coefficients from four
/// radtan ones. Without a size it is 0 and filled in from the pictures. Throws std::runtime_error naming
/// origin and field.
[[nodiscard]] StereoCalibration parse_opencv(const std::string& text, const std::string& origin);

/// Does this text have the fields of such a file?
[[nodiscard]] bool is_opencv_calibration(const std::string& text, const std::string& origin);

/// The inverse: YAML that parse_opencv() and OpenCV's FileStorage read.
[[nodiscard]] std::string format_opencv(const StereoCalibration& calibration);

}  // namespace flogmap
