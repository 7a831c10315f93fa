#include "camera/simulation/json_fields.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace flogmap {

JsonFields::JsonFields(const nlohmann::json& object, std::string place)
    : object_(&object), place_(std::move(place)) {
  if (!object.is_object())
    throw std::runtime_error(place_ + " must be an object {...}, got " + object.dump());
}

bool JsonFields::has(const std::string& key) {
  asked_.insert(key);
  return object_->contains(key);
}

const nlohmann::json& JsonFields::required(const std::string& key) {
  if (!has(key)) throw std::runtime_error(place_ + "." + key + " is missing");
  return (*object_)[key];
}

void JsonFields::fail(const std::string& key, const std::string& allowed) const {
  const auto found = object_->find(key);
  throw std::runtime_error(place_ + "." + key + " must be " + allowed + ", got " +
                           (found == object_->end() ? "nothing" : found->dump().substr(0, 80)));
}

std::string JsonFields::text(const std::string& key, const std::string& otherwise) {
  if (!has(key)) return otherwise;
  if (!required(key).is_string()) fail(key, "a text");
  return required(key).get<std::string>();
}

bool JsonFields::flag(const std::string& key, bool otherwise) {
  if (!has(key)) return otherwise;
  if (!required(key).is_boolean()) fail(key, "true or false");
  return required(key).get<bool>();
}

double JsonFields::number(const std::string& key, double otherwise, double low, double high) {
  if (!has(key)) return otherwise;
  const nlohmann::json& value = required(key);
  if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high)) {
    fail(key, "a number from " + nlohmann::json(low).dump() + " to " + nlohmann::json(high).dump());
  }
  return value.get<double>();
}

int JsonFields::whole(const std::string& key, int otherwise, int low, int high) {
  const double value = number(key, otherwise, low, high);
  if (value != std::floor(value)) fail(key, "a whole number");
  return static_cast<int>(value);
}

std::vector<double> JsonFields::numbers(const std::string& key) {
  const nlohmann::json& list = required(key);
  std::vector<double> values;
  for (const nlohmann::json& entry : list.is_array() ? list : nlohmann::json::array({nullptr})) {
    if (!entry.is_number() || std::abs(entry.get<double>()) > 1e6)
      fail(key, "a list of numbers (at most 1e6)");
    values.push_back(entry.get<double>());
  }
  return values;
}

std::vector<double> JsonFields::numbers(const std::string& key, std::size_t count) {
  std::vector<double> values = numbers(key);
  if (values.size() != count) fail(key, "a list of " + std::to_string(count) + " numbers");
  return values;
}

Eigen::Vector3d JsonFields::vector(const std::string& key) {
  return Eigen::Map<const Eigen::Vector3d>(numbers(key, 3).data());
}

Eigen::Vector3d JsonFields::vector(const std::string& key, const Eigen::Vector3d& otherwise) {
  return has(key) ? vector(key) : otherwise;
}

std::vector<JsonFields> JsonFields::objects(const std::string& key) {
  std::vector<JsonFields> fields;
  if (!has(key)) return fields;
  const nlohmann::json& list = required(key);
  if (!list.is_array()) fail(key, "a list");
  for (std::size_t i = 0; i < list.size(); ++i) {
    fields.emplace_back(list[i], place_ + "." + key + "[" + std::to_string(i) + "]");
  }
  return fields;
}

JsonFields JsonFields::object(const std::string& key) { return {required(key), place_ + "." + key}; }

void JsonFields::done() const {
  for (const auto& [key, value] : object_->items()) {
    if (asked_.contains(key)) continue;
    std::string allowed;
    for (const std::string& name : asked_) allowed += (allowed.empty() ? "" : ", ") + name;
    throw std::runtime_error(place_ + "." + key + " is unknown; allowed: " + allowed);
  }
}

}  // namespace flogmap
