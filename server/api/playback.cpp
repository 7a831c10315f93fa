// GET, PATCH /playback {position_s, rate, paused}; POST /playback:step
#include "server/api/json_body.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFastest = 100;

ApiResponse playback_response(ServerState& state) {
  const PlaybackState playback = state.control.playback();
  const Json json = {{"seekable", playback.seekable},     {"position_s", playback.position_s},
                     {"duration_s", playback.duration_s}, {"rate", playback.rate},
                     {"paused", playback.paused},         {"loop", playback.loop}};
  return json_response(json.dump());
}

ApiAnswer get_playback(const ApiRequest&, ServerState& state) { return playback_response(state); }

PlaybackChange requested_change(const nlohmann::json& body) {
  for (const auto& [name, value] : body.items()) {
    if (name != "position_s" && name != "rate" && name != "paused") {
      throw RefusedRequest(422, "unknown-field", "fields are position_s, rate and paused", name);
    }
  }
  PlaybackChange change;
  change.position_s = number_field(body, "position_s", 0, 1e9);
  change.rate = number_field(body, "rate", 0, kFastest);
  if (body.contains("paused")) {
    if (!body["paused"].is_boolean())
      throw RefusedRequest(422, "bad-value", "paused must be true or false", "paused");
    change.paused = body["paused"].get<bool>();
  }
  return change;
}

ApiAnswer answer_to(const ControlResult& result, ServerState& state) {
  if (result.outcome == ControlOutcome::illegal) return problem(409, "illegal-transition", result.detail);
  return playback_response(state);
}

ApiAnswer patch_playback(const ApiRequest& request, ServerState& state) {
  return answer_to(state.control.change_playback(requested_change(json_body(request))), state);
}

ApiAnswer step(const ApiRequest&, ServerState& state) { return answer_to(state.control.step(), state); }

}  // namespace

std::vector<Route> playback_routes() {
  return {{Method::get, "/api/v1/playback", Role::view, get_playback},
          {Method::patch, "/api/v1/playback", Role::control, patch_playback},
          {Method::post, "/api/v1/playback:step", Role::control, step}};
}

}  // namespace flogmap
