#include "camera/calibration/kalibr_calibration.hpp"

#include <stdexcept>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/yaml_fields.hpp"

namespace flogmap {
namespace {

CameraIntrinsics intrinsics_of(const YAML::Node& node, const std::string& origin, const std::string& name) {
  const auto place = [&](const char* field) { return yaml::Place{origin, name + "." + field}; };
  if (const std::string model = yaml::text(node, place("camera_model")); model != "pinhole") {
    throw std::runtime_error(place("camera_model").text() + " must be pinhole, got '" + model + "'");
  }
  CameraIntrinsics camera;
  const std::vector<double> k = yaml::numbers(node, place("intrinsics"), 4);
  set_pinhole(camera, k[0], k[1], k[2], k[3], place("intrinsics").text());
  set_resolution(camera, yaml::numbers(node, place("resolution")), place("resolution").text());
  set_distortion(camera, yaml::text(node, place("distortion_model")),
                 yaml::numbers(node, place("distortion_coeffs")), place("distortion_coeffs").text());
  return camera;
}

}  // namespace

StereoCalibration parse_kalibr(const std::string& text, const std::string& origin) {
  const YAML::Node root = yaml::parse(text, origin);
  const YAML::Node left = yaml::required(root, {origin, "cam0"}),
                   right = yaml::required(root, {origin, "cam1"});
  StereoCalibration calibration;
  calibration.left = intrinsics_of(left, origin, "cam0");
  calibration.right = intrinsics_of(right, origin, "cam1");
  calibration.right_from_left = yaml::transform(right, {origin, "cam1.T_cn_cnm1"});
  if (left["T_cam_imu"])
    calibration.body_from_left = yaml::transform(left, {origin, "cam0.T_cam_imu"}).inverse();
  calibration.dialect = "kalibr";
  calibration.origin = origin;
  return calibration;
}

}  // namespace flogmap
