#include "camera/calibration/yaml_fields.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "camera/calibration/calibration_checks.hpp"

namespace flogmap::yaml {
namespace {

/// OpenCV writes "%YAML:1.0" and tags that other YAML readers refuse or ignore.
std::string plain_yaml(const std::string& text) {
  std::istringstream in(text);
  std::string plain, line;
  while (std::getline(in, line)) {
    if (line.starts_with("%YAML")) line = "#" + line;
    for (const char* tag : {"!!opencv-matrix", "!<tag:yaml.org,2002:opencv-matrix>"}) {
      if (const auto at = line.find(tag); at != std::string::npos) line.erase(at, std::string(tag).size());
    }
    plain += line + '\n';
  }
  return plain;
}

void append_numbers(std::vector<double>& out, const YAML::Node& node, const Place& place) {
  if (node.IsSequence()) {
    for (const YAML::Node& entry : node) append_numbers(out, entry, place);
    return;
  }
  double value = 0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
    const std::string got = node.IsScalar() ? "'" + node.Scalar() + "'" : "no number";
    throw std::runtime_error(place.text() + " must hold finite numbers, got " + got);
  }
  out.push_back(value);
}

}  // namespace

YAML::Node parse(const std::string& text, const std::string& origin) {
  try {
    YAML::Node root = YAML::Load(plain_yaml(text));
    if (!root.IsMap()) throw std::runtime_error(origin + ": no YAML map of fields");
    return root;
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(origin + ":" + std::to_string(error.mark.line + 1) +
                             ": not valid YAML: " + error.msg);
  }
}

YAML::Node load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw std::runtime_error(file.string() + ": cannot be opened");
  std::ostringstream text;
  text << in.rdbuf();
  return parse(text.str(), file.string());
}

YAML::Node required(const YAML::Node& parent, const Place& place) {
  const std::string key = place.field.substr(place.field.rfind('.') + 1);
  const YAML::Node node = parent.IsMap() ? parent[key] : YAML::Node(YAML::NodeType::Undefined);
  if (!node) throw std::runtime_error(place.text() + " is missing");
  return node;
}

std::string text(const YAML::Node& parent, const Place& place) {
  const YAML::Node node = required(parent, place);
  if (!node.IsScalar()) throw std::runtime_error(place.text() + " must be a word");
  return node.Scalar();
}

double number(const YAML::Node& parent, const Place& place) { return numbers(parent, place, 1).front(); }

std::vector<double> numbers(const YAML::Node& parent, const Place& place) {
  YAML::Node node = required(parent, place);
  if (node.IsMap() && node["data"]) node.reset(node["data"]);
  std::vector<double> values;
  append_numbers(values, node, place);
  return values;
}

std::vector<double> numbers(const YAML::Node& parent, const Place& place, std::size_t count) {
  std::vector<double> values = numbers(parent, place);
  if (values.size() != count) {
    throw std::runtime_error(place.text() + " must have " + std::to_string(count) + " numbers, got " +
                             std::to_string(values.size()));
  }
  return values;
}

Eigen::Isometry3d transform(const YAML::Node& parent, const Place& place) {
  const std::vector<double> v = numbers(parent, place);
  if (v.size() != 16 && v.size() != 12) {
    throw std::runtime_error(place.text() + " must be a 4x4 matrix, got " + std::to_string(v.size()) +
                             " numbers");
  }
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = checked_rotation({v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10]}, place.text());
  result.translation() << v[3], v[7], v[11];
  return result;
}

}  // namespace flogmap::yaml
