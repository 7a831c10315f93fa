// One number for a whole map, to tell whether two runs agree.
#pragma once

#include <span>
#include <string>

#include "mapping/tile_update.hpp"
#include "server/map_store.hpp"
#include "server/publication.hpp"

namespace flogmap {

/// SHA-256, 64 hex digits, of grid, cells in the order of tiles, and poses. The order in which they came,
/// epoch, revisions and tiles without a seen cell make no difference; every seen cell and every pose does.
std::string map_digest(const MapSnapshot& map, std::span<const TrajectoryEntry> trajectory);
std::string map_digest(const StoredMap& map);

}  // namespace flogmap
