#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// One sensor.yaml of the EuRoC layout, with or without its %YAML line.
struct EurocCamera {
  CameraIntrinsics intrinsics;
  Eigen::Isometry3d body_from_sensor = Eigen::Isometry3d::Identity();  // T_BS
  std::optional<Eigen::Isometry3d> right_from_left{};  // which our own recordings say of the right camera
  bool rectified = false;  // "rectified: true", which our own recordings of rectified pictures say
};

/// Throws std::runtime_error naming file, field, value and what is allowed.
[[nodiscard]] EurocCamera read_euroc_camera(const std::filesystem::path& sensor_yaml);

/// "up_in_camera" of a sensor.yaml, which our own recordings say: the direction against gravity at the first
/// frame, unit length; nothing elsewhere. Throws if it is no direction.
[[nodiscard]] std::optional<Eigen::Vector3d> read_up_in_camera(const std::filesystem::path& sensor_yaml);

/// T_BS alone: what an inertial sensor's sensor.yaml is read for.
[[nodiscard]] Eigen::Isometry3d read_euroc_extrinsics(const std::filesystem::path& sensor_yaml);

/// The pair from two sensor.yaml files.
[[nodiscard]] StereoCalibration read_euroc_pair(const std::filesystem::path& left_yaml,
                                                const std::filesystem::path& right_yaml);

}  // namespace flogmap
