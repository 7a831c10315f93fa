#pragma once

#include <filesystem>

#include "camera/picture_pair_source.hpp"

namespace flogmap {

/// Lists a KITTI odometry sequence: DIR/image_0 and image_1 (grey) or image_2 and image_3 (colour),
/// times.txt, calib.txt; or a KITTI raw drive: image_00/data and image_01/data, with calib_cam_to_cam.txt in
/// DIR or above it. Without times.txt the pictures are 0.1 s apart. Throws std::runtime_error naming what is
/// missing or wrong.
[[nodiscard]] PicturePairList list_kitti(const std::filesystem::path& folder, bool needs_calibration);

}  // namespace flogmap
