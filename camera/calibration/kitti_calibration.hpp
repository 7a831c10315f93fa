#pragma once

#include <filesystem>
#include <string>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// KITTI's calib.txt (P0 .. P3: 3x4 projections of rectified cameras) or calib_cam_to_cam.txt (P_rect_00 ..).
/// `left` and `right` are camera numbers: 0 and 1 grey, 2 and 3 colour. calib.txt does not say the
/// resolution: it is then 0 and filled in from the pictures. Throws std::runtime_error naming file and field.
[[nodiscard]] StereoCalibration read_kitti_pair(const std::filesystem::path& file, int left, int right);

/// Does this text look like such a file?
[[nodiscard]] bool is_kitti_calibration(const std::string& text);

/// A rotation by its name, of any of KITTI's calib_*.txt: nine numbers, row by row.
[[nodiscard]] Eigen::Matrix3d read_kitti_rotation(const std::filesystem::path& file, const std::string& name);

}  // namespace flogmap
