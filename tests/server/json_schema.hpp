#pragma once

#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>
#include <string>

namespace flogmap {

/// Follows "#/components/schemas/Map" in an OpenAPI document.
YAML::Node resolved(const YAML::Node& document, const YAML::Node& node);

/// Empty if the value fits the schema, else the first fault: "/tiles/3/rev: is no integer". Knows what our
/// document uses: type, enum, required, properties, items, minimum, maximum, minItems, maxItems and $ref.
std::string fault_by_schema(const YAML::Node& document, const YAML::Node& schema, const nlohmann::json& value,
                            const std::string& where = "");

}  // namespace flogmap
