#include "camera/calibration/detect.hpp"

#include <stdexcept>

#include "camera/calibration/euroc_calibration.hpp"

namespace flogmap {

namespace fs = std::filesystem;

StereoCalibration read_calibration(const fs::path& path) {
  if (!fs::exists(path)) throw std::runtime_error(path.string() + ": no such calibration");
  const fs::path base = fs::is_directory(path / "mav0") ? path / "mav0" : path;
  if (fs::exists(base / "cam0" / "sensor.yaml")) {
    return read_euroc_pair(base / "cam0" / "sensor.yaml", base / "cam1" / "sensor.yaml");
  }
  throw std::runtime_error(path.string() +
                           ": not a stereo calibration; allowed: a folder with cam0/sensor.yaml and "
                           "cam1/sensor.yaml (EuRoC)");
}

}  // namespace flogmap
