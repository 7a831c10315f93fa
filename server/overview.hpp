// Coarser levels of the map, such that neither planning nor motion ever hides a danger. FLOG.md section 5.
#pragma once

#include <array>
#include <vector>

#include "mapping/tile_update.hpp"
#include "server/tile_planes.hpp"

namespace flogmap {

/// The four tiles below an overview tile, lower left, lower right, upper left, upper right; null: never seen.
using ChildTiles = std::array<const Tile*, 4>;

/// One cell out of the four below it: K E by min, K O by max, K by max, change by max; E and O are then
/// divided by the new K. Unseen cells count with K E = 0. N_K: full_confidence_rays of their layer.
Cell overview_cell(const std::array<Cell, 4>& cells, float N_K);

/// The tile that covers four, half as fine. Its cells' `rays` stop at N_K, and its revision is the newest.
Tile overview_tile(const ChildTiles& children, const MapInfo& info);

/// The plane M that covers four planes M, by max; an empty child plane is all zero.
PlaneBytes overview_value_plane(const std::array<const PlaneBytes*, 4>& children);

}  // namespace flogmap
