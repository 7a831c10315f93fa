// POST /maps/{id}/route {from, to, robot_radius_m}: a path on the safe-for-motion map.
#include "mapping/flog/route.hpp"

#include "server/api/json_body.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostRadiusM = 5;

/// [x, y] or {"x": .., "y": ..}, metres.
Eigen::Vector2d point_field(const nlohmann::json& body, const char* name) {
  const auto& point = body.contains(name) ? body[name] : nlohmann::json();
  const bool pair = point.is_array() && point.size() == 2 && point[0].is_number() && point[1].is_number();
  const bool named = point.is_object() && point.contains("x") && point.contains("y") &&
                     point["x"].is_number() && point["y"].is_number();
  if (pair) return {point[0].get<double>(), point[1].get<double>()};
  if (named) return {point["x"].get<double>(), point["y"].get<double>()};
  throw RefusedRequest(422, "bad-value", std::string(name) + " must be [x, y] in metres", name);
}

RouteRequest requested_route(const nlohmann::json& body, const ServeOptions& options, const MapInfo& info) {
  RouteRequest route;
  route.from_m = point_field(body, "from");
  route.to_m = point_field(body, "to");
  const double most_m = 1e9 * info.grid.cell_size_m;
  if (!(route.from_m.cwiseAbs().maxCoeff() < most_m))
    throw RefusedRequest(422, "bad-value", "no cell lies so far out", "from");
  if (!(route.to_m.cwiseAbs().maxCoeff() < most_m))
    throw RefusedRequest(422, "bad-value", "no cell lies so far out", "to");
  route.robot_radius_m = options.robot.radius_m;
  if (body.contains("robot_radius_m")) {
    const auto& radius = body["robot_radius_m"];
    const double value = radius.is_number() ? radius.get<double>() : -1;
    if (!(value >= 0 && value <= kMostRadiusM)) {
      throw RefusedRequest(422, "bad-value", "robot_radius_m must be a number from 0 to 5", "robot_radius_m");
    }
    route.robot_radius_m = value;
  }
  if (options.robot.height_m > 0) route.heights = {0, options.robot.height_m};
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
  const RouteRequest route = requested_route(json_body(request), state.options, map.board().info());
  return ApiJob(
      [snapshot = map.snapshot(), route, epoch = map.epoch()] { return answer_of(*snapshot, route, epoch); });
}

}  // namespace

std::vector<Route> route_routes() {
  return {{Method::post, "/api/v1/maps/{}/route", Role::view, post_route}};
}

}  // namespace flogmap
