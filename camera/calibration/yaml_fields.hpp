// Fields of a YAML file with errors that name file, field and value. For .cpp files of the readers only.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap::yaml {

/// Reads a file, tolerating OpenCV's "%YAML:1.0" line, which is no valid YAML, and its "!!opencv-matrix"
/// tags.
[[nodiscard]] YAML::Node load(const std::filesystem::path& file);
[[nodiscard]] YAML::Node parse(const std::string& text, const std::string& origin);

/// A place in a file, for messages: "cam0/sensor.yaml: T_BS".
struct Place {
  std::string file;
  std::string field;
  [[nodiscard]] std::string text() const { return file + ": " + field; }
};

[[nodiscard]] YAML::Node required(const YAML::Node& parent, const Place& place);
[[nodiscard]] std::string text(const YAML::Node& parent, const Place& place);
[[nodiscard]] double number(const YAML::Node& parent, const Place& place);

/// A flat or nested list of finite numbers, or an OpenCV matrix {rows, cols, data}.
[[nodiscard]] std::vector<double> numbers(const YAML::Node& parent, const Place& place);
[[nodiscard]] std::vector<double> numbers(const YAML::Node& parent, const Place& place, std::size_t count);

/// A list of 16 (4x4) or 12 (3x4) numbers as a rigid transform; its rotation is checked and made exact.
[[nodiscard]] Eigen::Isometry3d transform(const YAML::Node& parent, const Place& place);

}  // namespace flogmap::yaml
