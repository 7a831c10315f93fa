// GET /healthz, /readyz, /metrics
#include <nlohmann/json.hpp>

#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

ApiAnswer get_healthz(const ApiRequest&, ServerState&) { return json_response(R"({"status":"alive"})"); }

/// What keeps the server from being ready, in words.
std::vector<std::string> reasons_not_ready(const ServerState& state) {
  std::vector<std::string> reasons;
  if (state.draining) reasons.emplace_back("shutting down");
  if (!state.live) reasons.emplace_back("the map has not begun yet: source and calibration are being opened");
  if (state.session_state() == SessionState::failed)
    reasons.push_back("the source failed: " + state.control.reason());
  return reasons;
}

ApiAnswer get_readyz(const ApiRequest&, ServerState& state) {
  const std::vector<std::string> reasons = reasons_not_ready(state);
  const Json json = {{"ready", reasons.empty()}, {"reasons", reasons}, {"warnings", state.status.warnings}};
  ApiResponse response = json_response(json.dump(), reasons.empty() ? 200 : 503);
  if (!reasons.empty()) response.headers.emplace_back("Retry-After", "1");
  return response;
}

/// How much waits where. Every queue is bounded; one that is always full shows who is too slow.
void collect_queues(ServerState& state) {
  const auto set = [&state](const std::string& queue, std::size_t waiting) {
    state.metrics.set("flogmap_queue_depth", "Entries that wait, by queue", "queue", queue,
                      static_cast<double>(waiting));
  };
  for (const QueueReport& queue : state.status.queues) set(queue.queue, queue.waiting);
  set("queries", state.num_waiting_queries);
  set("viewer_tiles", state.num_waiting_tiles);
  set("viewer_tiles_slowest", state.most_waiting_tiles);
}

void collect(ServerState& state) {
  Metrics& metrics = state.metrics;
  const StatusReport& report = state.status;
  const ServingStatus serving = state.serving_status();
  metrics.set("flogmap_viewers", "Pages connected to the stream", serving.viewers);
  metrics.set("flogmap_map_tiles", "Tiles of the live map", static_cast<double>(serving.tiles));
  metrics.set("flogmap_map_bytes", "Memory of the live map's cells", static_cast<double>(serving.map_bytes));
  metrics.set("flogmap_map_revision", "Revision of the live map",
              state.live ? static_cast<double>(state.live->revision()) : 0);
  metrics.set("flogmap_frames_per_second", "Frames processed a second, lately", report.frames_per_s);
  metrics.set("flogmap_frames", "Frames of this run", static_cast<double>(report.frames));
  metrics.set("flogmap_frames_lost", "Frames without a pose", static_cast<double>(report.lost));
  metrics.set("flogmap_frames_dropped", "Frames dropped because the queue was full",
              static_cast<double>(report.dropped_frames));
  metrics.set("flogmap_frames_skipped", "Frames that could not be read",
              static_cast<double>(report.skipped_frames));
  metrics.set("flogmap_views_mapped", "Views in the map", static_cast<double>(report.mapped_views));
  metrics.set("flogmap_views_waiting", "Views whose place in the map is not known yet",
              static_cast<double>(report.waiting_views));
  metrics.set("flogmap_loops", "Loops closed", static_cast<double>(report.loops));
  if (report.skew) {
    metrics.set_skew(report.skew->histogram);
    metrics.set("flogmap_pairs_dropped", "Pairs taken further apart than allowed",
                static_cast<double>(report.skew->num_dropped));
  }
  if (report.processor_celsius) {
    metrics.set("flogmap_processor_celsius", "Warmest sensor of the processor", *report.processor_celsius);
  }
  for (const StageReport& stage : report.stages) metrics.set_stage(stage);
  collect_queues(state);
}

ApiAnswer get_metrics(const ApiRequest&, ServerState& state) {
  collect(state);
  ApiResponse response;
  response.content_type = "text/plain; version=0.0.4; charset=utf-8";
  response.body = to_shared(state.metrics.text());
  return response;
}

}  // namespace

std::vector<Route> health_routes() {
  return {{Method::get, "/healthz", Role::none, get_healthz},
          {Method::get, "/readyz", Role::none, get_readyz},
          {Method::get, "/metrics", Role::view, get_metrics}};
}

}  // namespace flogmap
