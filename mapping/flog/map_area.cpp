#include "mapping/flog/map_area.hpp"

#include <algorithm>

namespace flogmap {
namespace {

void include(MapArea& area, CellIndex low, CellIndex high) {
  if (area.empty()) {
    area = {low, high};
    return;
  }
  area.low = {std::min(area.low.x, low.x), std::min(area.low.y, low.y)};
  area.high = {std::max(area.high.x, high.x), std::max(area.high.y, high.y)};
}

bool seen(const Tile& tile, int column) {
  for (std::size_t i = column; i < tile.cells.size(); i += kTileColumns) {
    if (tile.cells[i].rays > 0) return true;
  }
  return false;
}

}  // namespace

MapArea intersection(const MapArea& a, const MapArea& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
}

MapArea tiled_area(const MapSnapshot& map) {
  MapArea area;
  for (const auto& [index, tile] : map.tiles) {
    const CellIndex low = first_cell(index);
    include(area, low, {low.x + kTileSide, low.y + kTileSide});
  }
  return area;
}

MapArea seen_area(const MapSnapshot& map) {
  MapArea area;
  for (const auto& [index, tile] : map.tiles) {
    const CellIndex first = first_cell(index);
    for (int column = 0; column < kTileColumns; ++column) {
      const CellIndex cell{first.x + (column & kTileMask), first.y + (column >> kTileShift)};
      const bool inside = area.contains(cell);
      if (!inside && seen(*tile, column)) include(area, cell, {cell.x + 1, cell.y + 1});
    }
  }
  return area;
}

Cell cell_in(const MapSnapshot& map, CellIndex column, int layer) {
  const auto tile = map.tiles.find(tile_of(column));
  if (tile == map.tiles.end()) return {};
  return tile->second->cells[std::size_t(layer) * kTileColumns + column_in_tile(column)];
}

std::size_t map_bytes(const MapSnapshot& map) {
  std::size_t bytes = 0;
  for (const auto& [index, tile] : map.tiles) bytes += tile->cells.size() * sizeof(Cell);
  return bytes;
}

}  // namespace flogmap
