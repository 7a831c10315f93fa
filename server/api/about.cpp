// GET /config, /calibration, /version
#include <nlohmann/json.hpp>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

ApiAnswer get_config(const ApiRequest&, ServerState& state) {
  return tagged_json(state.info.config_json, etag_of_text(state.info.config_json));
}

ApiAnswer get_calibration(const ApiRequest&, ServerState& state) {
  return tagged_json(state.info.calibration_json, etag_of_text(state.info.calibration_json));
}

ApiAnswer get_version(const ApiRequest&, ServerState& state) {
  const nlohmann::ordered_json json = {
      {"name", "flogmap"}, {"version", state.info.version}, {"stream_versions", {kProtocolVersion}}};
  std::string text = json.dump();
  const std::string etag = etag_of_text(text);
  return tagged_json(std::move(text), etag);
}

}  // namespace

std::vector<Route> about_routes() {
  return {{Method::get, "/api/v1/config", Role::view, get_config},
          {Method::get, "/api/v1/calibration", Role::view, get_calibration},
          {Method::get, "/api/v1/version", Role::none, get_version}};
}

}  // namespace flogmap
