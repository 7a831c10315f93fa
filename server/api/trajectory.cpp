// GET /maps/{id}/trajectory?from=&format=json|pb|tum|kitti
#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/export/trajectory_text.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;
using Entries = std::span<const TrajectoryEntry>;

std::string to_json(const ServedMap& map, std::size_t from, Entries entries) {
  Json points = Json::array();
  for (const TrajectoryEntry& entry : entries) {
    const Eigen::Vector3d t = entry.world_from_camera.translation();
    const Eigen::Quaterniond q(entry.world_from_camera.rotation());
    points.push_back({{"time_ns", std::to_string(entry.timestamp_ns)},
                      {"position", {t.x(), t.y(), t.z()}},
                      {"orientation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
                      {"state", name_of(entry.state)},
                      {"mapped", entry.mapped}});
  }
  return Json{{"epoch", map.epoch()}, {"from", from}, {"total", map.trajectory().size()}, {"points", points}}
      .dump();
}

std::string requested_format(const ApiRequest& request) {
  if (const auto format = request.parameter("format")) {
    if (*format == "json" || *format == "pb" || *format == "tum" || *format == "kitti")
      return std::string(*format);
    throw RefusedRequest(400, "bad-parameter", "format must be json, pb, tum or kitti", "format");
  }
  const auto type = negotiate(request.accept, {"application/json", "application/x-protobuf", "text/plain"});
  if (!type)
    throw RefusedRequest(406, "not-acceptable",
                         "offered: application/json, application/x-protobuf, text/plain");
  return *type == "application/json" ? "json" : *type == "text/plain" ? "tum" : "pb";
}

ApiAnswer get_trajectory(const ApiRequest& request, ServerState& state) {
  const ServedMap& map = requested_map(request, state);
  const auto length = static_cast<std::int64_t>(map.trajectory().size());
  const std::string format = requested_format(request);
  const std::int64_t from = std::min(integer_parameter(request, "from", 0, 0, INT64_MAX), length);
  const Entries entries = Entries(map.trajectory()).subspan(static_cast<std::size_t>(from));
  const std::string etag = etag_with_path(map, request, state.options);
  ApiResponse response = nothing_new(etag);
  response.headers.emplace_back("Vary", "Accept");
  if (is_known(request, etag)) return response;
  if (format == "json") {
    response.content_type = "application/json";
    response.body = to_shared(to_json(map, static_cast<std::size_t>(from), entries));
    return response;
  }
  response.content_type = format == "pb" ? "application/x-protobuf" : "text/plain; charset=utf-8";
  response.body = to_shared(format == "pb"    ? encode_trajectory(map.epoch(), entries)
                            : format == "tum" ? tum_of(entries)
                                              : kitti_of(entries));
  return response;
}

}  // namespace

std::vector<Route> trajectory_routes() {
  return {{Method::get, "/api/v1/maps/{}/trajectory", Role::view, get_trajectory}};
}

}  // namespace flogmap
