// Finding one's way in a snapshot of the map.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mapping/tile_update.hpp"

namespace flogmap {

/// A rectangle of columns: low inclusive, high exclusive.
struct MapArea {
  CellIndex low, high;

  [[nodiscard]] bool empty() const { return low.x >= high.x || low.y >= high.y; }
  [[nodiscard]] std::int64_t width() const { return std::int64_t{high.x} - low.x; }
  [[nodiscard]] std::int64_t height() const { return std::int64_t{high.y} - low.y; }
  [[nodiscard]] bool contains(CellIndex cell) const {
    return cell.x >= low.x && cell.y >= low.y && cell.x < high.x && cell.y < high.y;
  }
  bool operator==(const MapArea&) const = default;
};

/// What lies in both.
MapArea intersection(const MapArea& a, const MapArea& b);

/// The smallest area that holds all tiles; empty for an empty map. Takes time by the number of tiles.
MapArea tiled_area(const MapSnapshot& map);

/// The smallest area that holds all columns with a ray in any layer. Looks at every cell.
MapArea seen_area(const MapSnapshot& map);

/// An unseen cell where there is no tile.
Cell cell_in(const MapSnapshot& map, CellIndex column, int layer);

/// Memory of all cells, bytes.
std::size_t map_bytes(const MapSnapshot& map);

}  // namespace flogmap
