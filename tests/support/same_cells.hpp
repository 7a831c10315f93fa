// Two maps cell by cell.
#pragma once

#include <gtest/gtest.h>

#include "mapping/tile_update.hpp"

namespace flogmap {

/// Tiles of the first map with other cells in the second; one that the second lacks must be unseen.
inline int num_differing_tiles(const MapSnapshot& from, const MapSnapshot& to) {
  int count = 0;
  for (const auto& [index, tile] : from.tiles) {
    const auto other = to.tiles.find(index);
    const TileCells unseen(tile->cells.size());
    count += tile->cells == (other == to.tiles.end() ? unseen : other->second->cells) ? 0 : 1;
  }
  return count;
}

inline void expect_same_cells(const MapSnapshot& a, const MapSnapshot& b) {
  EXPECT_FALSE(a.tiles.empty());
  EXPECT_EQ(num_differing_tiles(a, b), 0);
  EXPECT_EQ(num_differing_tiles(b, a), 0);
}

}  // namespace flogmap
