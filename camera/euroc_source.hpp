#pragma once

#include <filesystem>

#include "camera/picture_pair_source.hpp"

namespace flogmap {

/// Lists the EuRoC layout: DIR/mav0/{cam0,cam1}/{sensor.yaml,data.csv,data/}, or DIR = mav0 itself; imu0 if
/// present. Rows of the two cameras are paired by time. `needs_calibration`: the sensor.yaml files must be
/// readable. Throws std::runtime_error naming what is missing or wrong.
[[nodiscard]] PicturePairList list_euroc(const std::filesystem::path& folder, bool needs_calibration);

}  // namespace flogmap
