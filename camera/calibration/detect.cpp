#include "camera/calibration/detect.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/euroc_calibration.hpp"
#include "camera/calibration/kalibr_calibration.hpp"
#include "camera/calibration/kitti_calibration.hpp"
#include "camera/calibration/opencv_calibration.hpp"
#include "camera/calibration/ros_calibration.hpp"
#include "camera/calibration/yaml_fields.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

CalibrationText read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || !fs::is_regular_file(file))
    throw std::runtime_error(file.string() + ": no such calibration file");
  constexpr std::uintmax_t kMostBytes = 1U << 20;
  if (fs::file_size(file) > kMostBytes)
    throw std::runtime_error(file.string() + ": too large for a calibration");
  std::ostringstream text;
  text << in.rdbuf();
  return {text.str(), file.string()};
}

StereoCalibration read_pair(const fs::path& left, const fs::path& right) {
  const CalibrationText left_text = read_text(left), right_text = read_text(right);
  const YAML::Node root = yaml::parse(left_text.text, left_text.origin);
  if (root["T_BS"]) return read_euroc_pair(left, right);
  if (root["camera_matrix"]) return parse_ros_pair(left_text, right_text);
  throw std::runtime_error(left_text.origin +
                           ": neither an EuRoC sensor.yaml (T_BS) nor a ROS camera_info "
                           "(camera_matrix)");
}

StereoCalibration read_one(const fs::path& file) {
  const CalibrationText file_text = read_text(file);
  const auto& [text, origin] = file_text;
  if (is_kitti_calibration(text)) return read_kitti_pair(file, 0, 1);
  if (is_opencv_calibration(text, origin)) return parse_opencv(text, origin);
  const YAML::Node root = yaml::parse(text, origin);
  if (root["cam0"]) return parse_kalibr(text, origin);
  if (root["T_BS"] || root["camera_matrix"]) {
    throw std::runtime_error(origin + ": describes one camera; give both files as LEFT,RIGHT");
  }
  throw std::runtime_error(
      origin +
      ": not a stereo calibration; allowed: Kalibr camchain (cam0, cam1), OpenCV "
      "stereoCalibrate (M1, D1, M2, D2, R, T), KITTI calib.txt (P0, P1), or two files LEFT,RIGHT "
      "of EuRoC (T_BS) or ROS (camera_matrix)");
}

StereoCalibration read_folder(const fs::path& folder) {
  const fs::path base = fs::is_directory(folder / "mav0") ? folder / "mav0" : folder;
  if (fs::exists(base / "cam0" / "sensor.yaml")) {
    return read_pair(base / "cam0" / "sensor.yaml", base / "cam1" / "sensor.yaml");
  }
  if (fs::exists(folder / "left.yaml")) return read_pair(folder / "left.yaml", folder / "right.yaml");
  for (const char* name : {"calib.txt", "calib.yaml", "camchain.yaml"}) {
    if (fs::exists(folder / name)) return read_one(folder / name);
  }
  throw std::runtime_error(folder.string() +
                           ": no calibration in this folder; looked for mav0/cam0/sensor.yaml, "
                           "left.yaml, calib.txt, calib.yaml, camchain.yaml");
}

}  // namespace

StereoCalibration read_calibration(const std::string& path) {
  const std::size_t comma = path.find(',');
  StereoCalibration calibration;
  if (comma != std::string::npos && !fs::exists(path)) {
    calibration = read_pair(path.substr(0, comma), path.substr(comma + 1));
  } else {
    calibration = fs::is_directory(path) ? read_folder(path) : read_one(path);
  }
  check_baseline(calibration);
  return calibration;
}

}  // namespace flogmap
