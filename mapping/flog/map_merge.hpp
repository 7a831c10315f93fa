// Two maps become one.
#pragma once

#include "mapping/tile_update.hpp"

namespace flogmap {

/// Where the second map lies in the first: p_in_a = rotated by yaw_rad p_in_b + (x_m, y_m).
struct MapPlacement {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;
};

/// The cells of both, weighted by their rays: N E = N_a E_a + N_b E_b, and O alike; N adds up, at most to
/// N_f. Rays of b count by what they are worth in b: scaled by N_K of a over N_K of b. A whole number of
/// cells and no turn is exact; otherwise each cell of the result is the mean of four points of b. The
/// revision is one above a's. Throws std::runtime_error naming the field if cells or layers differ.
MapSnapshot merge_maps(const MapSnapshot& a, const MapSnapshot& b, const MapPlacement& b_in_a);

}  // namespace flogmap
