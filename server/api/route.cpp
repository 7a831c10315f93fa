// POST /maps/{id}/route {from, to, robot_radius_m, robot_height_m}: a path on the safe-for-motion map.
// POST /maps/{id}/reachable {from, robot_radius_m, robot_height_m}: everywhere that such paths lead.
// `from` is [x, y] or the word "camera".
#include "mapping/flog/route.hpp"

#include <optional>
#include <utility>

#include "server/api/json_body.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostRobotM = 5;
constexpr double kFromCameraM = 1.5;  // what stands under a camera is seldom seen: begin nearby instead

/// [x, y] or {"x": .., "y": ..}, metres.
Eigen::Vector2d point_field(const nlohmann::json& body, const char* name) {
  const auto& point = body.contains(name) ? body[name] : nlohmann::json();
  const bool pair = point.is_array() && point.size() == 2 && point[0].is_number() && point[1].is_number();
  const bool named = point.is_object() && point.contains("x") && point.contains("y") &&
                     point["x"].is_number() && point["y"].is_number();
  if (pair) return {point[0].get<double>(), point[1].get<double>()};
  if (named) return {point["x"].get<double>(), point["y"].get<double>()};
  throw RefusedRequest(422, "bad-value",
                       std::string(name) + " must be [x, y] in metres" +
                           (name == std::string_view("from") ? ", or \"camera\"" : ""),
                       name);
}

/// A length of the robot; nothing if the body does not name it.
std::optional<double> robot_field(const nlohmann::json& body, const char* name) {
  if (!body.contains(name)) return std::nullopt;
  const double value = body[name].is_number() ? body[name].get<double>() : -1;
  if (value >= 0 && value <= kMostRobotM) return value;
  throw RefusedRequest(422, "bad-value", std::string(name) + " must be a number from 0 to 5", name);
}

Eigen::Vector2d place_field(const nlohmann::json& body, const char* name, const MapInfo& info) {
  const Eigen::Vector2d place_m = point_field(body, name);
  if (place_m.cwiseAbs().maxCoeff() < 1e9 * info.grid.cell_size_m) return place_m;
  throw RefusedRequest(422, "bad-value", "no cell lies so far out", name);
}

/// Where the camera is now.
Eigen::Vector2d camera_place(const ServedMap& map) {
  if (!map.trajectory().empty()) return map.trajectory().back().world_from_camera.translation().head<2>();
  throw RefusedRequest(422, "no-camera", "the camera has no place on this map yet; give from as [x, y]",
                       "from");
}

/// All but where the robot wants to go.
RouteRequest requested_start(const nlohmann::json& body, const ServeOptions& options, const ServedMap& map) {
  RouteRequest route;
  const bool from_camera = body.contains("from") && body["from"] == "camera";
  route.from_m = from_camera ? camera_place(map) : place_field(body, "from", map.board().info());
  if (from_camera) route.start_snap_m = kFromCameraM;
  route.robot_radius_m = robot_field(body, "robot_radius_m").value_or(options.robot.radius_m);
  const double height_m = robot_field(body, "robot_height_m").value_or(options.robot.height_m);
  if (height_m > 0) route.heights = {0, height_m};
  route.operators = options.operators;
  return route;
}

std::string_view code_of(RouteOutcome outcome) {
  switch (outcome) {
    case RouteOutcome::start_unknown:
      return "start-unknown";
    case RouteOutcome::start_blocked:
      return "start-blocked";
    case RouteOutcome::goal_unknown:
      return "goal-unknown";
    case RouteOutcome::goal_blocked:
      return "goal-blocked";
    case RouteOutcome::unreachable:
      return "unreachable";
    case RouteOutcome::found:
      break;
  }
  return "found";
}

ApiResponse answer_of(const MapSnapshot& map, const RouteRequest& request, const std::string& epoch) {
  const RouteResult result = find_route(map, request);
  if (!result.found()) return problem(422, code_of(result.outcome), result.reason);
  Json path = Json::array();
  for (const Eigen::Vector2d& corner : result.path_m) path.push_back({corner.x(), corner.y()});
  return json_response(Json{{"epoch", epoch},
                            {"rev", map.revision},
                            {"path", path},
                            {"length_m", result.length_m},
                            {"clearance_m", result.least_clearance_m},
                            {"robot_radius_m", request.robot_radius_m}}
                           .dump());
}

ApiAnswer post_route(const ApiRequest& request, ServerState& state) {
  ServedMap& map = requested_map(request, state);
  const nlohmann::json body = json_body(request);
  RouteRequest route = requested_start(body, state.options, map);
  route.to_m = place_field(body, "to", map.board().info());
  return ApiJob(
      [snapshot = map.snapshot(), route, epoch = map.epoch()] { return answer_of(*snapshot, route, epoch); });
}

/// Row by row from the lowest y: cells not reached, cells reached, cells not reached ...
Json runs_of(const Image<std::uint8_t>& reached) {
  Json runs = Json::array();
  std::uint8_t now = 0;
  std::int64_t length = 0;
  for (int y = reached.height - 1; y >= 0; --y) {
    for (int x = 0; x < reached.width; ++x) {
      if (reached.at(x, y) == now) {
        ++length;
      } else {
        runs.push_back(std::exchange(length, 1));
        now = reached.at(x, y);
      }
    }
  }
  runs.push_back(length);
  return runs;
}

ApiResponse reachable_answer(const MapSnapshot& map, const RouteRequest& request, const std::string& epoch) {
  const ReachableArea area = find_reachable(map, request);
  if (!area.found()) return problem(422, code_of(area.outcome), area.reason);
  return json_response(Json{{"epoch", epoch},
                            {"rev", map.revision},
                            {"area_m2", area.area_m2},
                            {"origin", {area.reached.origin_x_m(), area.reached.origin_y_m()}},
                            {"cell_size", area.reached.cell_size_m},
                            {"width", area.reached.grey.width},
                            {"height", area.reached.grey.height},
                            {"runs", runs_of(area.reached.grey)}}
                           .dump());
}

ApiAnswer post_reachable(const ApiRequest& request, ServerState& state) {
  ServedMap& map = requested_map(request, state);
  RouteRequest start = requested_start(json_body(request), state.options, map);
  start.start_snap_m = kFromCameraM;
  return ApiJob([snapshot = map.snapshot(), start, epoch = map.epoch()] {
    return reachable_answer(*snapshot, start, epoch);
  });
}

}  // namespace

std::vector<Route> route_routes() {
  return {{Method::post, "/api/v1/maps/{}/route", Role::view, post_route},
          {Method::post, "/api/v1/maps/{}/reachable", Role::view, post_reachable}};
}

}  // namespace flogmap
