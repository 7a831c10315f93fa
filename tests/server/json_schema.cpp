#include "tests/server/json_schema.hpp"

namespace flogmap {
namespace {

using nlohmann::json;

bool has_type(const std::string& type, const json& value) {
  return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
         (type == "string" && value.is_string()) || (type == "integer" && value.is_number_integer()) ||
         (type == "number" && value.is_number()) || (type == "boolean" && value.is_boolean()) ||
         (type == "null" && value.is_null());
}

std::string fault_of_type(const YAML::Node& type, const json& value) {
  if (!type) return "";
  std::string allowed;
  for (std::size_t i = 0; i < (type.IsSequence() ? type.size() : 1); ++i) {
    const std::string name = (type.IsSequence() ? YAML::Node(type[i]) : type).as<std::string>();
    if (has_type(name, value)) return "";
    allowed += (allowed.empty() ? "" : " or ") + name;
  }
  return "is no " + allowed;
}

std::string fault_of_range(const YAML::Node& schema, const json& value) {
  if (value.is_number()) {
    const auto number = value.get<double>();
    if (schema["minimum"] && number < schema["minimum"].as<double>()) return "is too small";
    if (schema["maximum"] && number > schema["maximum"].as<double>()) return "is too large";
  }
  if (value.is_array()) {
    if (schema["minItems"] && value.size() < schema["minItems"].as<std::size_t>()) return "is too short";
    if (schema["maxItems"] && value.size() > schema["maxItems"].as<std::size_t>()) return "is too long";
  }
  if (!schema["enum"]) return "";
  for (const auto& allowed : schema["enum"]) {
    if (value.is_string() && value.get<std::string>() == allowed.as<std::string>()) return "";
  }
  return "is none of the values named";
}

}  // namespace

YAML::Node resolved(const YAML::Node& document, const YAML::Node& node) {
  if (!node.IsMap() || !node["$ref"]) return node;
  std::string path = node["$ref"].as<std::string>().substr(2) + "/";
  YAML::Node at = document;
  for (std::size_t end; (end = path.find('/')) != std::string::npos; path.erase(0, end + 1)) {
    const YAML::Node below = at[path.substr(0, end)];
    at.reset(below);
  }
  return at;
}

std::string fault_by_schema(const YAML::Node& document, const YAML::Node& given, const json& value,
                            const std::string& where) {
  const YAML::Node schema = resolved(document, given);
  for (const std::string& fault : {fault_of_type(schema["type"], value), fault_of_range(schema, value)}) {
    if (!fault.empty()) return where + ": " + fault;
  }
  for (const auto& name : schema["required"]) {
    if (!value.contains(name.as<std::string>())) return where + "/" + name.as<std::string>() + ": is missing";
  }
  for (const auto& property : schema["properties"]) {
    const auto name = property.first.as<std::string>();
    if (!value.is_object() || !value.contains(name)) continue;
    const std::string fault = fault_by_schema(document, property.second, value[name], where + "/" + name);
    if (!fault.empty()) return fault;
  }
  if (!schema["items"] || !value.is_array()) return "";
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string fault =
        fault_by_schema(document, schema["items"], value[i], where + "/" + std::to_string(i));
    if (!fault.empty()) return fault;
  }
  return "";
}

}  // namespace flogmap
