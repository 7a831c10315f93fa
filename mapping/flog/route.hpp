// A way for a robot through what is known to be free.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/flog/map_picture.hpp"
#include "mapping/flog/map_rules.hpp"
#include "mapping/tile_update.hpp"

namespace flogmap {

struct RouteRequest {
  Eigen::Vector2d from_m{0, 0};
  Eigen::Vector2d to_m{0, 0};
  double robot_radius_m = 0.2;
  HeightRange heights;  // layers that must be free
  Operators operators = Operators::algebraic;
  // An end where the robot does not fit moves to the nearest place within this, where it does.
  double start_snap_m = 0.3;
  double goal_snap_m = 0.3;
};

enum class RouteOutcome : std::uint8_t {
  found,
  start_unknown,
  start_blocked,
  goal_unknown,
  goal_blocked,
  unreachable,
};

struct RouteResult {
  RouteOutcome outcome = RouteOutcome::unreachable;
  std::string reason;                   // in words, unless found
  std::vector<Eigen::Vector2d> path_m;  // corners of the way, both ends included
  double length_m = 0;
  double least_clearance_m = 0;  // between the way and the nearest cell that is occupied or unknown, middle
                                 // to middle; at least the robot's radius

  [[nodiscard]] bool found() const { return outcome == RouteOutcome::found; }
};

/// Shortest way by A*, where narrow places cost up to three times their length. Unknown counts as occupied.
RouteResult find_route(const MapSnapshot& map, const RouteRequest& request);

/// Every cell that the middle of the robot can reach on ways known to be free.
struct ReachableArea {
  RouteOutcome outcome = RouteOutcome::unreachable;
  std::string reason;  // in words, unless found
  MapPicture reached;  // 1 where it can be, else 0
  double area_m2 = 0;

  [[nodiscard]] bool found() const { return outcome == RouteOutcome::found; }
};

/// `request.to_m` does not matter.
ReachableArea find_reachable(const MapSnapshot& map, const RouteRequest& request);

}  // namespace flogmap
