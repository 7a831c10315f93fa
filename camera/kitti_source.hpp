#pragma once

#include <filesystem>

#include "camera/picture_pair_source.hpp"

namespace flogmap {

/// Lists a KITTI odometry sequence: DIR/image_0 and image_1 (grey) or image_2 and image_3 (colour),
/// times.txt, calib.txt; or a KITTI raw drive (rectified): image_00/data and image_01/data, or 02 and 03,
/// image_0x/timestamps.txt, oxts for "up", with the calib_*.txt in DIR or above it. Without times the
/// pictures are taken to come at `rate_hz`, and the list says so. Throws std::runtime_error naming what is
/// missing or wrong.
[[nodiscard]] PicturePairList list_kitti(const std::filesystem::path& folder, bool needs_calibration,
                                         double rate_hz);

}  // namespace flogmap
