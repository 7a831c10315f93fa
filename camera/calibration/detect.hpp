#pragma once

#include <filesystem>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// Reads a stereo calibration of any dialect; which one is told by the content, never by the name.
/// Throws std::runtime_error naming file, field, value and what is allowed.
[[nodiscard]] StereoCalibration read_calibration(const std::filesystem::path& path);

}  // namespace flogmap
