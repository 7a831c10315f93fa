#pragma once

#include "mapping/flog/map_area.hpp"

namespace flogmap {

/// What a picture of the whole map shows: every column that was seen; of an empty map the one at the origin.
inline MapArea picture_area(const MapSnapshot& map) {
  const MapArea seen = seen_area(map);
  return seen.empty() ? MapArea{{0, 0}, {1, 1}} : seen;
}

}  // namespace flogmap
