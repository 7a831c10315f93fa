#include "camera/calibration/kitti_calibration.hpp"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/csv.hpp"

namespace flogmap {
namespace {

using Fields = std::map<std::string, std::string>;  // "P0" → "721.5 0 609.6 ..."

Fields read_fields(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    throw std::runtime_error(file.string() + ": cannot be opened");
  Fields fields;
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos) fields[line.substr(0, colon)] = line.substr(colon + 1);
  }
  return fields;
}

std::vector<double> numbers(const Fields& fields, const std::string& name, std::size_t count,
                            const std::string& file) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw std::runtime_error(file + ": " + name + " is missing");
  std::vector<double> values;
  std::istringstream in(found->second);
  for (std::string word; in >> word;) {
    double value = 0;
    if (!parse_number(word, value)) {
      throw std::runtime_error(file + ": " + name + " must hold finite numbers, got '" + word + "'");
    }
    values.push_back(value);
  }
  if (values.size() != count) {
    throw std::runtime_error(file + ": " + name + " must have " + std::to_string(count) + " numbers, got " +
                             std::to_string(values.size()));
  }
  return values;
}

}  // namespace

StereoCalibration read_kitti_pair(const std::filesystem::path& file, int left, int right) {
  const Fields fields = read_fields(file);
  const std::string where = file.string();
  const bool raw = fields.contains("P_rect_00");
  const std::string prefix = raw ? "P_rect_0" : "P";
  StereoCalibration calibration;
  double centre_m[2] = {0, 0};
  for (const bool is_left : {true, false}) {
    const std::string number = std::to_string(is_left ? left : right);
    const std::vector<double> P = numbers(fields, prefix + number, 12, where);
    CameraIntrinsics& camera = is_left ? calibration.left : calibration.right;
    set_pinhole(camera, P[0], P[5], P[2], P[6], where + ": " + prefix + number);
    if (raw)
      set_resolution(camera, numbers(fields, "S_rect_0" + number, 2, where), where + ": S_rect_0" + number);
    centre_m[is_left ? 0 : 1] = -P[3] / P[0];
  }
  calibration.right_from_left.translation() = Eigen::Vector3d(centre_m[0] - centre_m[1], 0, 0);
  calibration.rectified = true;
  calibration.dialect = "kitti";
  calibration.origin = where;
  return calibration;
}

Eigen::Matrix3d read_kitti_rotation(const std::filesystem::path& file, const std::string& name) {
  const std::vector<double> values = numbers(read_fields(file), name, 9, file.string());
  const Eigen::Matrix3d rotation =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
  constexpr double kRounding = 1e-3;
  if ((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() > kRounding)
    throw std::runtime_error(file.string() + ": " + name + " is no rotation");
  return rotation;
}

bool is_kitti_calibration(const std::string& text) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("P0:") || line.starts_with("P_rect_00:")) return true;
  }
  return false;
}

}  // namespace flogmap
