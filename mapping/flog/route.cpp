#include "mapping/flog/route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mapping/flog/distance_field.hpp"
#include "mapping/flog/grid_search.hpp"
#include "mapping/flog/map_picture.hpp"
#include "mapping/flog/map_planes.hpp"

namespace flogmap {
namespace {

/// The map as a grid of clearances, with the classes it comes from; row 0 at the highest y.
struct Ground {
  MapPicture classes;
  GridClearance grid;

  [[nodiscard]] GridPlace place(const Eigen::Vector2d& p_m) const {
    const double a = classes.cell_size_m;
    const double x = std::floor(p_m.x() / a) - classes.area.low.x;
    const double y = classes.area.high.y - 1 - std::floor(p_m.y() / a);
    // Far outside stays outside, without overflow.
    return {static_cast<int>(std::clamp(x, -1e6, 1e9)), static_cast<int>(std::clamp(y, -1e6, 1e9))};
  }
  [[nodiscard]] Eigen::Vector2d middle_m(GridPlace p) const {
    const double a = classes.cell_size_m;
    return {(classes.area.low.x + p.x + 0.5) * a, (classes.area.high.y - 1 - p.y + 0.5) * a};
  }
};

Ground ground_of(const MapSnapshot& map, const RouteRequest& request) {
  Rules rules;
  rules.operators = request.operators;
  rules.heights = request.heights;
  MapArea area = tiled_area(map);
  // Beyond the tiles everything is unknown; one cell of it all around is enough.
  area = {{area.low.x - 1, area.low.y - 1}, {area.high.x + 1, area.high.y + 1}};
  Ground ground{trinary_picture(map, area, std::nullopt, rules), {}};
  Image<std::uint8_t> blocked = ground.classes.grey;
  for (std::uint8_t& pixel : blocked.pixels) pixel = pixel == kTrinaryFree ? 0 : 1;
  const double a = map.info.grid.cell_size_m;
  ground.grid = {distance_to_blocked(blocked), static_cast<float>(request.robot_radius_m / a),
                 static_cast<float>((request.robot_radius_m + 0.3) / a)};
  return ground;
}

/// The nearest passable cell within `reach` cells.
std::optional<GridPlace> snapped(const GridClearance& grid, GridPlace wanted, double reach) {
  std::optional<GridPlace> best;
  double nearest = reach;
  const int r = static_cast<int>(reach);
  for (int dy = -r; dy <= r; ++dy) {
    for (int dx = -r; dx <= r; ++dx) {
      const double away = std::hypot(dx, dy);
      const GridPlace there{wanted.x + dx, wanted.y + dy};
      if (away > nearest || (best && away == nearest) || !grid.passable(there)) continue;
      best = there;
      nearest = away;
    }
  }
  return best;
}

RouteResult no_way(RouteOutcome outcome, std::string reason) {
  return {outcome, std::move(reason), {}, 0, 0};
}

RouteResult no_place(const Ground& ground, GridPlace place, bool start) {
  const bool inside = ground.classes.grey.contains(place.x, place.y);
  const bool unknown = !inside || ground.classes.grey.at(place.x, place.y) == kTrinaryUnknown;
  const std::string which = start ? "the start" : "the goal";
  if (unknown) {
    return no_way(start ? RouteOutcome::start_unknown : RouteOutcome::goal_unknown,
                  which + " lies where the map knows nothing yet");
  }
  return no_way(start ? RouteOutcome::start_blocked : RouteOutcome::goal_blocked,
                "the robot does not fit at " + which);
}

RouteResult route_along(const Ground& ground, const std::vector<GridPlace>& corners) {
  const double a = ground.classes.cell_size_m;
  RouteResult route;
  route.outcome = RouteOutcome::found;
  float least = ground.grid.clearance.at(corners.front().x, corners.front().y);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    route.path_m.push_back(ground.middle_m(corners[i]));
    if (i == 0) continue;
    route.length_m += (route.path_m[i] - route.path_m[i - 1]).norm();
    least = std::min(least, least_clearance(ground.grid, corners[i - 1], corners[i]));
  }
  route.least_clearance_m = least * a;
  return route;
}

/// Fills `reached` from `start` on over passable neighbours (four each: no corner is cut); returns how many.
std::int64_t spread(const GridClearance& grid, GridPlace start, Image<std::uint8_t>& reached) {
  std::vector<GridPlace> open{start};
  reached.at(start.x, start.y) = 1;
  std::int64_t count = 0;
  while (!open.empty()) {
    const GridPlace p = open.back();
    open.pop_back();
    ++count;
    for (const GridPlace next : {GridPlace{p.x + 1, p.y}, {p.x - 1, p.y}, {p.x, p.y + 1}, {p.x, p.y - 1}}) {
      if (!grid.passable(next) || reached.at(next.x, next.y) != 0) continue;
      reached.at(next.x, next.y) = 1;
      open.push_back(next);
    }
  }
  return count;
}

}  // namespace

ReachableArea find_reachable(const MapSnapshot& map, const RouteRequest& request) {
  if (map.tiles.empty()) return {RouteOutcome::start_unknown, "the map is empty", {}, 0};
  const Ground ground = ground_of(map, request);
  const auto start =
      snapped(ground.grid, ground.place(request.from_m), request.start_snap_m / map.info.grid.cell_size_m);
  if (!start) {
    const RouteResult why = no_place(ground, ground.place(request.from_m), true);
    return {why.outcome, why.reason, {}, 0};
  }
  ReachableArea area{RouteOutcome::found, {}, ground.classes, 0};
  area.reached.grey = Image<std::uint8_t>(ground.classes.grey.width, ground.classes.grey.height);
  const double a = ground.classes.cell_size_m;
  area.area_m2 = static_cast<double>(spread(ground.grid, *start, area.reached.grey)) * a * a;
  return area;
}

RouteResult find_route(const MapSnapshot& map, const RouteRequest& request) {
  if (map.tiles.empty()) return no_way(RouteOutcome::start_unknown, "the map is empty");
  const Ground ground = ground_of(map, request);
  const double a = map.info.grid.cell_size_m;
  const auto from = snapped(ground.grid, ground.place(request.from_m), request.start_snap_m / a);
  if (!from) return no_place(ground, ground.place(request.from_m), true);
  const auto to = snapped(ground.grid, ground.place(request.to_m), request.goal_snap_m / a);
  if (!to) return no_place(ground, ground.place(request.to_m), false);
  const std::vector<GridPlace> way = cheapest_way(ground.grid, *from, *to);
  if (way.empty()) {
    return no_way(RouteOutcome::unreachable, "no way that is known to be free is wide enough for the robot");
  }
  return route_along(ground, straightened(ground.grid, way));
}

}  // namespace flogmap
