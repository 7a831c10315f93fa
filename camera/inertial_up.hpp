#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <vector>

namespace flogmap {

/// "Up" in the raw left camera, unit length: the mean of the accelerometer over the resting start of an EuRoC
/// imu0 folder (data.csv, sensor.yaml). Nothing if there is no such folder or it does not begin at rest.
/// Throws std::runtime_error if its sensor.yaml is unusable.
[[nodiscard]] std::optional<Eigen::Vector3d> inertial_up(const std::filesystem::path& imu_folder,
                                                         const Eigen::Isometry3d& body_from_left);

/// One sample of an accelerometer; m/s^2, seconds since the first sample.
struct Acceleration {
  double time_s;
  Eigen::Vector3d in_sensor;
};

/// The mean over the resting start: the time, at most 2 s, in which the mean of every tenth of a second stays
/// within 0.4 m/s^2 of that of the first half second. Nothing if that is shorter than half a second or is not
/// gravity (9.81 +- 0.5 m/s^2).
[[nodiscard]] std::optional<Eigen::Vector3d> resting_acceleration(const std::vector<Acceleration>& samples);

}  // namespace flogmap
