// Reading JSON objects strictly: every error names the place, every key must be known. For .cpp files of
// camera/ only.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace flogmap {

/// The fields of one JSON object. Call done() after the last field: it refuses keys nobody asked for.
class JsonFields {
 public:
  JsonFields(const nlohmann::json& object, std::string place);

  [[nodiscard]] bool has(const std::string& key);
  [[nodiscard]] const nlohmann::json& required(const std::string& key);
  [[nodiscard]] std::string text(const std::string& key, const std::string& otherwise);
  [[nodiscard]] bool flag(const std::string& key, bool otherwise);
  /// A number in [low, high].
  [[nodiscard]] double number(const std::string& key, double otherwise, double low, double high);
  [[nodiscard]] int whole(const std::string& key, int otherwise, int low, int high);
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count);
  [[nodiscard]] std::vector<double> numbers(const std::string& key);
  [[nodiscard]] Eigen::Vector3d vector(const std::string& key);
  [[nodiscard]] Eigen::Vector3d vector(const std::string& key, const Eigen::Vector3d& otherwise);
  /// The elements of a list, each with its place for messages.
  [[nodiscard]] std::vector<JsonFields> objects(const std::string& key);
  [[nodiscard]] JsonFields object(const std::string& key);

  void done() const;
  [[noreturn]] void fail(const std::string& key, const std::string& allowed) const;
  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  const nlohmann::json* object_;
  std::string place_;
  std::set<std::string> asked_;
};

}  // namespace flogmap
