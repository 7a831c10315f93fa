// How thick and how strong the side of a box stands in the map.
#pragma once

#include <Eigen/Core>

#include "mapping/tile_update.hpp"

namespace flogmap::experiments {

/// A vertical surface seen from above; outside is to the left of the way from `from_m` to `to_m`.
struct Side {
  Eigen::Vector2d from_m, to_m;
};

/// The profile across a side, taken as the mean along its middle half.
struct SideProfile {
  double width_m = 0;       // between the places where the map value, with full confidence, is half its peak
  double peak = 0;          // of the map value with full confidence,
  double visible_peak = 0;  // and as shown, confidence included
  double confidence = 0;    // where that peak is
};

[[nodiscard]] SideProfile profile_of(const MapSnapshot& map, int layer, const Side& side);

}  // namespace flogmap::experiments
