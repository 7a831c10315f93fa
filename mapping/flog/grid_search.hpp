// A* on a grid of clearances.
#pragma once

#include <vector>

#include "camera/image.hpp"

namespace flogmap {

struct GridPlace {
  int x = 0;
  int y = 0;
  bool operator==(const GridPlace&) const = default;
};

/// Where one may go, and what it costs; all in cells.
struct GridClearance {
  Image<float> clearance;  // to the nearest blocked cell
  float least = 0;         // cells with less may not be entered
  float comfortable = 0;   // from here on a step costs its length; down to `least` up to three times as much

  [[nodiscard]] bool passable(GridPlace p) const {
    return clearance.contains(p.x, p.y) && clearance.at(p.x, p.y) >= least && clearance.at(p.x, p.y) > 0;
  }
};

/// Cheapest way over neighbouring cells (eight each), ends included; empty if there is none. Both ends
/// passable.
std::vector<GridPlace> cheapest_way(const GridClearance& grid, GridPlace from, GridPlace to);

/// The same way with as few corners as straight lines allow that are nowhere narrower than what they replace
/// (or than what is comfortable).
std::vector<GridPlace> straightened(const GridClearance& grid, const std::vector<GridPlace>& way);

/// Least clearance along the straight line between two cells.
float least_clearance(const GridClearance& grid, GridPlace a, GridPlace b);

}  // namespace flogmap
