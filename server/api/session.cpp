// GET /session; POST /session:pause :resume :reset :level
#include <nlohmann/json.hpp>
#include <numbers>

#include "server/api/json_body.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

/// Nothing where pairs have one time only; else how many pairs were taken up to so far apart.
Json skew_json(const std::optional<PairSkew>& skew) {
  if (!skew) return nullptr;
  const SkewHistogram& histogram = skew->histogram;
  Json bins = Json::array();
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const bool bounded = i < SkewHistogram::kUpperMs.size();
    bins.push_back({{"up_to_ms", bounded ? Json(SkewHistogram::kUpperMs[i]) : Json(nullptr)},
                    {"pairs", histogram.counts[i]}});
  }
  return {{"mean_ms", histogram.mean_ms()},
          {"largest_ms", histogram.largest_ms},
          {"allowed_ms", skew->allowed_ms},
          {"dropped_pairs", skew->num_dropped},
          {"histogram", bins}};
}

constexpr double kDegrees = 180 / std::numbers::pi;

Json level_json(const LevelState& levelling) {
  const HandLevel& level = levelling.level;
  return {{"roll_deg", level.roll_rad * kDegrees},
          {"pitch_deg", level.pitch_rad * kDegrees},
          {"yaw_deg", level.yaw_rad * kDegrees},
          {"height_m", level.height_m},
          {"obstacle", levelling.obstacle.empty() ? Json(nullptr) : Json(levelling.obstacle)}};
}

ApiResponse session_response(ServerState& state) {
  const StatusReport& report = state.status;
  Json json = {
      {"state", name_of(state.session_state())},
      {"reason", state.control.reason()},
      {"source", state.control.source()},
      {"live", state.control.live()},
      {"epoch", state.live ? Json(state.live->epoch()) : Json(nullptr)},
      {"rev", state.live ? Json(state.live->revision()) : Json(nullptr)},
      {"frames_per_s", report.frames_per_s},
      {"frames", report.frames},
      {"tracked", report.tracked},
      {"lost", report.lost},
      {"mapped_views", report.mapped_views},
      {"waiting_views", report.waiting_views},
      {"loops", report.loops},
      {"dropped_frames", report.dropped_frames},
      {"skipped_frames", report.skipped_frames},
      {"pair_skew", skew_json(report.skew)},
      {"processor_celsius", report.processor_celsius ? Json(*report.processor_celsius) : Json(nullptr)},
      {"alignment", report.alignment},
      {"level", level_json(state.control.levelling())},
      {"viewers", state.num_viewers},
      {"warnings", report.warnings}};
  return json_response(json.dump());
}

ApiAnswer get_session(const ApiRequest&, ServerState& state) { return session_response(state); }

ApiAnswer answer_to(const ControlResult& result, ServerState& state) {
  if (result.outcome == ControlOutcome::illegal) return problem(409, "illegal-transition", result.detail);
  return session_response(state);
}

ApiAnswer pause(const ApiRequest&, ServerState& state) { return answer_to(state.control.pause(), state); }
ApiAnswer resume(const ApiRequest&, ServerState& state) { return answer_to(state.control.resume(), state); }
ApiAnswer reset(const ApiRequest&, ServerState& state) { return answer_to(state.control.reset(), state); }

HandLevel requested_level(const nlohmann::json& body, const HandLevel& now) {
  constexpr double kHighest_m = 100;
  for (const auto& [name, value] : body.items()) {
    if (name != "roll_deg" && name != "pitch_deg" && name != "yaw_deg" && name != "height_m") {
      throw RefusedRequest(422, "unknown-field", "fields are roll_deg, pitch_deg, yaw_deg and height_m",
                           name);
    }
  }
  const auto angle_rad = [&](const char* name, double otherwise_rad) {
    const std::optional<double> angle_deg = number_field(body, name, -180, 180);
    return angle_deg ? *angle_deg / kDegrees : otherwise_rad;
  };
  return {angle_rad("roll_deg", now.roll_rad), angle_rad("pitch_deg", now.pitch_rad),
          angle_rad("yaw_deg", now.yaw_rad),
          number_field(body, "height_m", -kHighest_m, kHighest_m).value_or(now.height_m)};
}

ApiAnswer level(const ApiRequest& request, ServerState& state) {
  const HandLevel wanted = requested_level(json_body(request), state.control.levelling().level);
  return answer_to(state.control.level(wanted), state);
}

}  // namespace

std::vector<Route> session_routes() {
  return {{Method::get, "/api/v1/session", Role::view, get_session},
          {Method::post, "/api/v1/session:pause", Role::control, pause},
          {Method::post, "/api/v1/session:resume", Role::control, resume},
          {Method::post, "/api/v1/session:reset", Role::control, reset},
          {Method::post, "/api/v1/session:level", Role::control, level}};
}

}  // namespace flogmap
