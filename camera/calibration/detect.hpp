#pragma once

#include <string>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// Reads a stereo calibration of any dialect; which one is told by the content, never by the name. `path` is
/// a file (Kalibr camchain, OpenCV YAML or XML, KITTI), two files "LEFT,RIGHT" (EuRoC sensor.yaml, ROS
/// camera_info), or a folder (EuRoC layout; left.yaml and right.yaml; calib.txt; calib.yaml). Throws
/// std::runtime_error naming file, field, value and what is allowed.
[[nodiscard]] StereoCalibration read_calibration(const std::string& path);

}  // namespace flogmap
