#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

namespace flogmap {

/// "Up" in the rectified left camera, unit length, as the inertial sensor of a KITTI raw drive knows it at
/// the first picture (roll and pitch of the first file of `oxts`/data). `calibration` holds
/// calib_imu_to_velo.txt, calib_velo_to_cam.txt and calib_cam_to_cam.txt. Nothing where one of these files is
/// missing. Throws std::runtime_error naming file and field where one is damaged.
[[nodiscard]] std::optional<Eigen::Vector3d> kitti_up(const std::filesystem::path& oxts,
                                                      const std::filesystem::path& calibration);

}  // namespace flogmap
