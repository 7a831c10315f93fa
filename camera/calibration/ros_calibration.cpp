#include "camera/calibration/ros_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/yaml_fields.hpp"

namespace flogmap {
namespace {

struct Camera {
  CameraIntrinsics intrinsics;
  Eigen::Matrix3d rectified_from_raw = Eigen::Matrix3d::Identity();
  double shift_m = 0;  // of the camera's centre along the rectified x axis
};

RosCameraInfo parse_info(const CalibrationText& file) {
  const YAML::Node root = yaml::parse(file.text, file.origin);
  const auto place = [&](const char* field) { return yaml::Place{file.origin, field}; };
  RosCameraInfo info;
  info.origin = file.origin;
  info.width_px = yaml::number(root, place("image_width"));
  info.height_px = yaml::number(root, place("image_height"));
  info.camera_matrix = yaml::numbers(root, place("camera_matrix"), 9);
  info.distortion_model = yaml::text(root, place("distortion_model"));
  info.distortion_coefficients = yaml::numbers(root, place("distortion_coefficients"));
  info.rectification_matrix = yaml::numbers(root, place("rectification_matrix"));
  info.projection_matrix = yaml::numbers(root, place("projection_matrix"), 12);
  return info;
}

void check_count(const std::vector<double>& numbers, std::size_t count, const std::string& where) {
  if (numbers.size() == count) return;
  throw std::runtime_error(where + " must have " + std::to_string(count) + " numbers, got " +
                           std::to_string(numbers.size()));
}

/// Lenses as messages have them: drivers leave the model out where there is nothing to say, and fill the
/// rational one up with coefficients of OpenCV's thin prism, which are zero.
void set_lens(CameraIntrinsics& camera, const RosCameraInfo& info) {
  std::vector<double> D = info.distortion_coefficients;
  constexpr std::size_t kRational = 8;
  const auto zero_from = [&](std::size_t first) {
    return std::all_of(D.begin() + static_cast<std::ptrdiff_t>(std::min(first, D.size())), D.end(),
                       [](double value) { return value == 0; });
  };
  if (info.distortion_model == "rational_polynomial" && D.size() > kRational && zero_from(kRational))
    D.resize(kRational);
  const bool nothing_said = info.distortion_model.empty() && zero_from(0);
  set_distortion(camera, nothing_said ? "none" : info.distortion_model, D,
                 info.origin + ": distortion_coefficients");
}

Camera camera_of(const RosCameraInfo& info, bool rectified) {
  const auto place = [&](const char* field) { return info.origin + ": " + field; };
  const std::vector<double>&K = info.camera_matrix, &P = info.projection_matrix;
  check_count(K, 9, place("camera_matrix"));
  check_count(P, 12, place("projection_matrix"));
  Camera camera;
  set_resolution(camera.intrinsics, {info.width_px, info.height_px}, place("image_width, image_height"));
  CameraIntrinsics projection = camera.intrinsics;
  if (!rectified) {
    set_pinhole(camera.intrinsics, K[0], K[4], K[2], K[5], place("camera_matrix"));
    set_lens(camera.intrinsics, info);
    camera.rectified_from_raw = checked_rotation(info.rectification_matrix, place("rectification_matrix"));
  }
  set_pinhole(projection, P[0], P[5], P[2], P[6], place("projection_matrix"));
  if (rectified) camera.intrinsics = projection;
  camera.shift_m = -P[3] / P[0];
  return camera;
}

}  // namespace

StereoCalibration ros_calibration(const RosCameraInfo& left_info, const RosCameraInfo& right_info,
                                  bool rectified) {
  const Camera left = camera_of(left_info, rectified), right = camera_of(right_info, rectified);
  constexpr double kShortest_m = 1e-6;
  if (std::abs(left.shift_m - right.shift_m) < kShortest_m) {
    throw std::runtime_error(right_info.origin +
                             ": projection_matrix[3] must be -fx * baseline, got that of the left camera; "
                             "cameras calibrated one by one need a stereo calibration: --calibration FILE");
  }
  StereoCalibration calibration;
  calibration.left = left.intrinsics;
  calibration.right = right.intrinsics;
  calibration.rectified = rectified;
  const Eigen::Vector3d between(left.shift_m - right.shift_m, 0, 0);  // rectified right from rectified left
  calibration.right_from_left.linear() = right.rectified_from_raw.transpose() * left.rectified_from_raw;
  calibration.right_from_left.translation() = right.rectified_from_raw.transpose() * between;
  calibration.dialect = "ros";
  calibration.origin = left_info.origin;
  return calibration;
}

StereoCalibration parse_ros_pair(const CalibrationText& left, const CalibrationText& right) {
  return ros_calibration(parse_info(left), parse_info(right), false);
}

}  // namespace flogmap
