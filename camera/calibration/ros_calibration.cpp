#include "camera/calibration/ros_calibration.hpp"

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/yaml_fields.hpp"

namespace flogmap {
namespace {

struct CameraInfo {
  CameraIntrinsics intrinsics;
  Eigen::Matrix3d rectified_from_raw;
  double shift_m;  // of the camera's centre along the rectified x axis
};

CameraInfo read_camera(const CalibrationText& file) {
  const YAML::Node root = yaml::parse(file.text, file.origin);
  const auto place = [&](const char* field) { return yaml::Place{file.origin, field}; };
  CameraInfo info;
  set_resolution(info.intrinsics,
                 {yaml::number(root, place("image_width")), yaml::number(root, place("image_height"))},
                 file.origin + ": image_width, image_height");
  const std::vector<double> K = yaml::numbers(root, place("camera_matrix"), 9);
  set_pinhole(info.intrinsics, K[0], K[4], K[2], K[5], place("camera_matrix").text());
  set_distortion(info.intrinsics, yaml::text(root, place("distortion_model")),
                 yaml::numbers(root, place("distortion_coefficients")),
                 place("distortion_coefficients").text());
  info.rectified_from_raw = checked_rotation(yaml::numbers(root, place("rectification_matrix")),
                                             place("rectification_matrix").text());
  const std::vector<double> P = yaml::numbers(root, place("projection_matrix"), 12);
  CameraIntrinsics projection;
  set_pinhole(projection, P[0], P[5], P[2], P[6], place("projection_matrix").text());
  info.shift_m = -P[3] / P[0];
  return info;
}

}  // namespace

StereoCalibration parse_ros_pair(const CalibrationText& left_file, const CalibrationText& right_file) {
  const CameraInfo left = read_camera(left_file), right = read_camera(right_file);
  StereoCalibration calibration;
  calibration.left = left.intrinsics;
  calibration.right = right.intrinsics;
  const Eigen::Vector3d between(left.shift_m - right.shift_m, 0, 0);  // rectified right from rectified left
  calibration.right_from_left.linear() = right.rectified_from_raw.transpose() * left.rectified_from_raw;
  calibration.right_from_left.translation() = right.rectified_from_raw.transpose() * between;
  calibration.dialect = "ros";
  calibration.origin = left_file.origin;
  return calibration;
}

}  // namespace flogmap
