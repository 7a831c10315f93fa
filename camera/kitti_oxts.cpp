#include "camera/kitti_oxts.hpp"

#include <Eigen/Geometry>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera/calibration/kitti_calibration.hpp"
#include "camera/csv.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

/// The first line's numbers: latitude, longitude, altitude, roll, pitch, yaw [rad], and more.
std::vector<double> first_fix(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::istringstream words(line);
  std::vector<double> values;
  for (std::string word; words >> word;) {
    double value = 0;
    if (!parse_number(word, value))
      throw std::runtime_error(file.string() + ": must hold numbers, got '" + word + "'");
    values.push_back(value);
  }
  constexpr std::size_t kUpToYaw = 6;
  if (values.size() < kUpToYaw)
    throw std::runtime_error(file.string() + ": must have at least 6 numbers, got " +
                             std::to_string(values.size()));
  return values;
}

fs::path first_file(const fs::path& folder) {
  fs::path first;
  if (!fs::is_directory(folder)) return first;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".txt" && (first.empty() || entry.path() < first)) first = entry.path();
  }
  return first;
}

}  // namespace

std::optional<Eigen::Vector3d> kitti_up(const fs::path& oxts, const fs::path& calibration) {
  const fs::path first = first_file(oxts / "data");
  const fs::path velo_from_imu = calibration / "calib_imu_to_velo.txt";
  const fs::path camera_from_velo = calibration / "calib_velo_to_cam.txt";
  const fs::path cameras = calibration / "calib_cam_to_cam.txt";
  for (const fs::path& file : {first, velo_from_imu, camera_from_velo, cameras}) {
    if (file.empty() || !fs::exists(file)) return std::nullopt;
  }
  const std::vector<double> fix = first_fix(first);
  // world_from_imu = Rz(yaw) Ry(pitch) Rx(roll), x forward, y left, z up; a turn about "up" does not move it.
  const Eigen::Matrix3d level_from_imu = (Eigen::AngleAxisd(fix[4], Eigen::Vector3d::UnitY()) *
                                          Eigen::AngleAxisd(fix[3], Eigen::Vector3d::UnitX()))
                                             .toRotationMatrix();
  const Eigen::Matrix3d rectified_from_imu = read_kitti_rotation(cameras, "R_rect_00") *
                                             read_kitti_rotation(camera_from_velo, "R") *
                                             read_kitti_rotation(velo_from_imu, "R");
  const Eigen::Vector3d up_in_imu = level_from_imu.transpose() * Eigen::Vector3d::UnitZ();
  return Eigen::Vector3d(rectified_from_imu * up_in_imu).normalized();
}

}  // namespace flogmap
