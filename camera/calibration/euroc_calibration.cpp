#include "camera/calibration/euroc_calibration.hpp"

#include <cmath>
#include <stdexcept>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/yaml_fields.hpp"

namespace flogmap {

EurocCamera read_euroc_camera(const std::filesystem::path& sensor_yaml) {
  const YAML::Node root = yaml::load(sensor_yaml);
  const std::string file = sensor_yaml.string();
  EurocCamera camera;
  if (const std::string model = yaml::text(root, {file, "camera_model"}); model != "pinhole") {
    throw std::runtime_error(file + ": camera_model must be pinhole, got '" + model + "'");
  }
  set_resolution(camera.intrinsics, yaml::numbers(root, {file, "resolution"}), file + ": resolution");
  const std::vector<double> k = yaml::numbers(root, {file, "intrinsics"}, 4);
  set_pinhole(camera.intrinsics, k[0], k[1], k[2], k[3], file + ": intrinsics");
  set_distortion(camera.intrinsics, yaml::text(root, {file, "distortion_model"}),
                 yaml::numbers(root, {file, "distortion_coefficients"}), file + ": distortion_coefficients");
  camera.body_from_sensor = yaml::transform(root, {file, "T_BS"});
  if (root["right_from_left"]) camera.right_from_left = yaml::transform(root, {file, "right_from_left"});
  camera.rectified = root["rectified"] && yaml::text(root, {file, "rectified"}) == "true";
  return camera;
}

std::optional<Eigen::Vector3d> read_up_in_camera(const std::filesystem::path& sensor_yaml) {
  const YAML::Node root = yaml::load(sensor_yaml);
  if (!root["up_in_camera"]) return std::nullopt;
  const std::vector<double> up = yaml::numbers(root, {sensor_yaml.string(), "up_in_camera"}, 3);
  const Eigen::Vector3d direction(up[0], up[1], up[2]);
  constexpr double kRounding = 1e-3;
  if (std::abs(direction.norm() - 1) > kRounding)
    throw std::runtime_error(sensor_yaml.string() + ": up_in_camera must have length 1, has " +
                             std::to_string(direction.norm()));
  return direction;
}

Eigen::Isometry3d read_euroc_extrinsics(const std::filesystem::path& sensor_yaml) {
  return yaml::transform(yaml::load(sensor_yaml), {sensor_yaml.string(), "T_BS"});
}

StereoCalibration read_euroc_pair(const std::filesystem::path& left_yaml,
                                  const std::filesystem::path& right_yaml) {
  const EurocCamera left = read_euroc_camera(left_yaml);
  const EurocCamera right = read_euroc_camera(right_yaml);
  StereoCalibration calibration;
  calibration.left = left.intrinsics;
  calibration.right = right.intrinsics;
  calibration.body_from_left = left.body_from_sensor;
  calibration.right_from_left =
      right.right_from_left.value_or(right.body_from_sensor.inverse() * left.body_from_sensor);
  calibration.rectified = left.rectified && right.rectified;
  calibration.dialect = "euroc";
  calibration.origin = left_yaml.string();
  return calibration;
}

}  // namespace flogmap
