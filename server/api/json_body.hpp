#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/api/parameters.hpp"

namespace flogmap {

/// The JSON object of a request's body: 415 for another content type, 400 if it is not an object.
inline nlohmann::json json_body(const ApiRequest& request) {
  if (!request.content_type.starts_with("application/json")) {
    throw RefusedRequest(415, "json-needed", "send application/json", "Content-Type");
  }
  nlohmann::json json = nlohmann::json::parse(request.body, nullptr, false);
  if (!json.is_object()) throw RefusedRequest(400, "bad-json", "the body must be one JSON object");
  return json;
}

/// A string of that object; 422 if it is missing or something else.
inline std::string string_field_of_json(const ApiRequest& request, const char* name) {
  const nlohmann::json json = json_body(request);
  if (json.contains(name) && json[name].is_string()) return json[name].get<std::string>();
  throw RefusedRequest(422, "missing-field", std::string(name) + " must be a string", name);
}

/// A number of an object, if it is there; 422 if it is no number from `least` to `most`.
inline std::optional<double> number_field(const nlohmann::json& body, const char* name, double least,
                                          double most) {
  if (!body.contains(name)) return std::nullopt;
  const auto& field = body[name];
  const double value = field.is_number() ? field.get<double>() : NAN;
  if (value >= least && value <= most) return value;
  throw RefusedRequest(
      422, "bad-value",
      std::string(name) + " must be a number from " + std::to_string(least) + " to " + std::to_string(most),
      name);
}

}  // namespace flogmap
