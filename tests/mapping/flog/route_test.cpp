#include "mapping/flog/route.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <queue>
#include <random>

#include "mapping/flog/distance_field.hpp"
#include "mapping/flog/grid_search.hpp"
#include "tests/mapping/flog/map_canvas.hpp"

namespace flogmap {
namespace {

using test::kFreeCell;
using test::kOccupiedCell;
using test::MapCanvas;

RouteRequest way(double x0, double y0, double x1, double y1, double radius_m = 0.2) {
  RouteRequest request;
  request.from_m = {x0, y0};
  request.to_m = {x1, y1};
  request.robot_radius_m = radius_m;
  request.start_snap_m = request.goal_snap_m = 0.05;
  return request;
}

/// Two rooms of 4 x 4 m with a wall between, and a door of door_cells cells in its middle (y from 2 m on).
MapCanvas two_rooms(int door_cells) {
  MapCanvas canvas;
  canvas.fill({0, 0}, {400, 200}, kFreeCell);
  canvas.fill({200, 0}, {205, 100}, kOccupiedCell);
  canvas.fill({200, 100 + door_cells}, {205, 200}, kOccupiedCell);
  return canvas;
}

TEST(DistanceField, EqualsBruteForce) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> percent(0, 99);
  for (const int share : {0, 1, 5, 50}) {
    Image<std::uint8_t> blocked(31, 24);
    for (auto& pixel : blocked.pixels) pixel = percent(random) < share ? 1 : 0;
    const Image<float> distance = distance_to_blocked(blocked);
    for (int y = 0; y < blocked.height; ++y) {
      for (int x = 0; x < blocked.width; ++x) {
        double nearest = INFINITY;
        for (int v = 0; v < blocked.height; ++v) {
          for (int u = 0; u < blocked.width; ++u) {
            if (blocked.at(u, v) != 0) nearest = std::min(nearest, std::hypot(u - x, v - y));
          }
        }
        ASSERT_FLOAT_EQ(distance.at(x, y), static_cast<float>(nearest));
      }
    }
  }
}

/// Cost of the cheapest way by plain relaxation until nothing changes.
double cheapest_by_force(const GridClearance& grid, GridPlace from, GridPlace to) {
  const auto per_cell = [&](int x, int y) {
    const double room = grid.comfortable - grid.least;
    const double tight = std::clamp((grid.comfortable - grid.clearance.at(x, y)) / room, 0.0, 1.0);
    return 1 + 2 * tight * tight;
  };
  Image<double> cost(grid.clearance.width, grid.clearance.height, INFINITY);
  cost.at(from.x, from.y) = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y < cost.height; ++y) {
      for (int x = 0; x < cost.width; ++x) {
        if (!grid.passable({x, y})) continue;
        for (int v = std::max(0, y - 1); v <= std::min(cost.height - 1, y + 1); ++v) {
          for (int u = std::max(0, x - 1); u <= std::min(cost.width - 1, x + 1); ++u) {
            if (!grid.passable({u, v})) continue;
            const double step = std::hypot(u - x, v - y) * (per_cell(x, y) + per_cell(u, v)) / 2;
            if (cost.at(u, v) + step < cost.at(x, y) - 1e-9) changed = true;
            cost.at(x, y) = std::min(cost.at(x, y), cost.at(u, v) + step);
          }
        }
      }
    }
  }
  return cost.at(to.x, to.y);
}

TEST(GridSearch, FindsTheCheapestWay) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> percent(0, 99);
  int found = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Image<std::uint8_t> blocked(26, 20);
    for (auto& pixel : blocked.pixels) pixel = percent(random) < 14 ? 1 : 0;
    GridClearance grid{distance_to_blocked(blocked), 1, 4};
    const GridPlace from{1, 1}, to{24, 18};
    grid.clearance.at(1, 1) = grid.clearance.at(24, 18) = 2;
    const double expected = cheapest_by_force(grid, from, to);
    const auto cells = cheapest_way(grid, from, to);
    ASSERT_EQ(cells.empty(), std::isinf(expected));
    if (cells.empty()) continue;
    ++found;
    GridClearance open = grid;  // the cost of what was found, step by step
    double cost = 0;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      for (auto& c : open.clearance.pixels) c = 0;
      for (const GridPlace p : {cells[i - 1], cells[i]})
        open.clearance.at(p.x, p.y) = grid.clearance.at(p.x, p.y);
      cost += cheapest_by_force(open, cells[i - 1], cells[i]);
    }
    EXPECT_NEAR(cost, expected, 1e-3);
  }
  EXPECT_GT(found, 10);
}

TEST(Route, InTheOpenIsTheStraightLine) {
  MapCanvas canvas;
  canvas.fill({0, 0}, {200, 200}, kFreeCell);
  const RouteResult route = find_route(canvas.map(), way(1, 1, 3, 2.5));
  ASSERT_TRUE(route.found()) << route.reason;
  EXPECT_EQ(route.path_m.size(), 2U);
  EXPECT_NEAR(route.length_m, 2.5, 0.05);
}

TEST(Route, GoesThroughADoorThatIsWideEnough) {
  const RouteResult route = find_route(two_rooms(40).map(), way(1, 1, 7, 1, 0.3));
  ASSERT_TRUE(route.found()) << route.reason;
  EXPECT_GE(route.least_clearance_m, 0.3);
  EXPECT_GT(route.length_m, 6);
  EXPECT_LT(route.length_m, 7.5);
}

TEST(Route, SaysSoWhereTheDoorIsTooNarrow) {
  const RouteResult route = find_route(two_rooms(40).map(), way(1, 1, 7, 1, 0.45));
  EXPECT_EQ(route.outcome, RouteOutcome::unreachable);
  EXPECT_FALSE(route.reason.empty());
  EXPECT_TRUE(route.path_m.empty());
}

TEST(Route, NowhereComesCloserThanTheRobotsRadius) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.5, 3.5);
  int found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    MapCanvas canvas;
    canvas.fill({0, 0}, {200, 200}, kFreeCell);
    std::vector<Eigen::Vector2d> posts;
    for (int i = 0; i < 12; ++i) {
      posts.emplace_back(place(random), place(random));
      const CellIndex cell = cell_at(canvas.map().info.grid, posts.back().x(), posts.back().y());
      canvas.set(cell, i % 3, kOccupiedCell);
    }
    const RouteResult route = find_route(canvas.map(), way(0.4, 0.4, 3.6, 3.6));
    if (!route.found()) continue;
    ++found;
    for (std::size_t i = 1; i < route.path_m.size(); ++i) {
      for (double s = 0; s <= 1; s += 0.01) {
        const Eigen::Vector2d p = route.path_m[i - 1] + s * (route.path_m[i] - route.path_m[i - 1]);
        for (const auto& post : posts) EXPECT_GE((p - post).norm(), 0.2 - 0.03);  // cells are 0.02 m
      }
    }
  }
  EXPECT_GT(found, 10);
}

TEST(Route, TakesTheUnknownForOccupied) {
  MapCanvas canvas;
  canvas.fill({0, 0}, {90, 100}, kFreeCell);
  canvas.fill({110, 0}, {200, 100}, kFreeCell);
  EXPECT_EQ(find_route(canvas.map(), way(1, 1, 3, 1)).outcome, RouteOutcome::unreachable);
}

TEST(Route, NeedsOnlyTheHeightsOfTheRobot) {
  MapCanvas canvas;
  for (int x = 0; x < 200; ++x) {
    for (int y = 0; y < 100; ++y) canvas.set({x, y}, 0, kFreeCell);
  }
  for (int y = 0; y < 100; ++y) canvas.set({100, y}, 2, kOccupiedCell);  // a beam overhead
  RouteRequest request = way(1, 1, 3, 1);
  EXPECT_FALSE(find_route(canvas.map(), request).found());
  request.heights = {0, 0.7};
  EXPECT_TRUE(find_route(canvas.map(), request).found());
}

TEST(Route, NamesTheEndThatIsImpossible) {
  const MapCanvas canvas = two_rooms(40);
  EXPECT_EQ(find_route(canvas.map(), way(-3, 1, 1, 1)).outcome, RouteOutcome::start_unknown);
  EXPECT_EQ(find_route(canvas.map(), way(1, 1, 1e9, 1)).outcome, RouteOutcome::goal_unknown);
  EXPECT_EQ(find_route(canvas.map(), way(4.05, 1, 1, 1)).outcome, RouteOutcome::start_blocked);
  EXPECT_EQ(find_route(canvas.map(), way(1, 1, 4.05, 1)).outcome, RouteOutcome::goal_blocked);
  EXPECT_EQ(find_route(MapSnapshot{}, way(1, 1, 2, 1)).outcome, RouteOutcome::start_unknown);
}

TEST(Route, FollowsTheMapAsItChanges) {
  MapCanvas canvas = two_rooms(40);
  EXPECT_TRUE(find_route(canvas.map(), way(1, 1, 7, 1, 0.3)).found());
  canvas.fill({200, 100}, {205, 140}, kOccupiedCell);  // the door is shut
  EXPECT_FALSE(find_route(canvas.map(), way(1, 1, 7, 1, 0.3)).found());
}

/// Cells that the robot's middle may be in, by brute force over single steps.
TEST(Reachable, IsWhereAWayLeadsAndNothingElse) {
  const MapCanvas canvas = two_rooms(20);  // a door of 0.4 m
  const MapSnapshot& map = canvas.map();
  for (const double radius : {0.1, 0.3}) {
    const ReachableArea area = find_reachable(map, way(1, 1, 0, 0, radius));
    ASSERT_TRUE(area.found());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> x(0.05, 7.9), y(0.05, 3.9);
    for (int i = 0; i < 60; ++i) {
      RouteRequest request = way(1, 1, x(random), y(random), radius);
      request.start_snap_m = request.goal_snap_m = 0;
      const CellIndex cell{static_cast<int>(request.to_m.x() / 0.02),
                           static_cast<int>(request.to_m.y() / 0.02)};
      const bool reached = area.reached.grey.at(area.reached.pixel_x(cell), area.reached.pixel_y(cell)) != 0;
      EXPECT_EQ(reached, find_route(map, request).found()) << request.to_m.transpose();
    }
  }
}

TEST(Reachable, AWiderRobotReachesLessAndOneInAWallNothing) {
  const MapCanvas canvas = two_rooms(20);
  const MapSnapshot& map = canvas.map();
  const double slim = find_reachable(map, way(1, 1, 0, 0, 0.1)).area_m2;
  const double wide = find_reachable(map, way(1, 1, 0, 0, 0.3)).area_m2;
  EXPECT_GT(slim, 2 * wide * 0.95);  // the other room too
  EXPECT_NEAR(wide, (4 - 0.6) * (4 - 0.6), 0.4);
  EXPECT_EQ(find_reachable(map, way(4.05, 1, 0, 0)).outcome, RouteOutcome::start_blocked);
  EXPECT_EQ(find_reachable(map, way(99, 1, 0, 0)).outcome, RouteOutcome::start_unknown);
}

}  // namespace
}  // namespace flogmap
