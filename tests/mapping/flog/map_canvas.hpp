// Maps drawn by hand, cell by cell.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "mapping/tile_update.hpp"

namespace flogmap::test {

inline constexpr Cell kOccupiedCell{0, 65535, 100, 0}, kFreeCell{65535, 0, 100, 0};

/// A map of 20 mm cells, three layers unless told otherwise, N_K = 100.
class MapCanvas {
 public:
  explicit MapCanvas(GridSpec grid = {}) {
    map_.info.grid = std::move(grid);
    map_.info.full_confidence_rays.assign(map_.info.grid.num_layers(), 100);
  }

  void set(CellIndex cell, int layer, Cell value) {
    auto& tile = tiles_[tile_of(cell)];
    const std::size_t size = map_.info.full_confidence_rays.size() * kTileColumns;
    if (!tile) tile = std::make_shared<Tile>(Tile{TileCells(size), 1});
    tile->cells[std::size_t(layer) * kTileColumns + column_in_tile(cell)] = value;
    map_.tiles[tile_of(cell)] = tile;
  }

  /// Every layer of the columns from low to high (exclusive).
  void fill(CellIndex low, CellIndex high, Cell value) {
    for (int x = low.x; x < high.x; ++x) {
      for (int y = low.y; y < high.y; ++y) {
        for (int k = 0; k < map_.info.grid.num_layers(); ++k) set({x, y}, k, value);
      }
    }
  }

  [[nodiscard]] const MapSnapshot& map() const { return map_; }

 private:
  MapSnapshot map_;
  std::map<TileIndex, std::shared_ptr<Tile>> tiles_;
};

}  // namespace flogmap::test
