// What leaves the map: immutable tiles, and a table of them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "mapping/flog/cell.hpp"
#include "mapping/flog/grid_spec.hpp"
#include "mapping/tile_memory.hpp"

namespace flogmap {

using TileCells = std::vector<Cell, TileAllocator<Cell>>;

/// 64 x 64 columns with all their layers: cells[layer * 4096 + column_in_tile(cell)].
struct Tile {
  TileCells cells;             // num_layers * 4096
  std::uint64_t revision = 0;  // of the map change that last touched this tile
};

/// A tile as it now is. It carries all of it, not a patch: applying it twice or skipping an older one
/// does no harm.
struct TileUpdate {
  TileIndex index;
  std::uint64_t revision = 0;
  std::shared_ptr<const Tile> tile;
};

/// Everything about a map that does not change while it grows.
struct MapInfo {
  GridSpec grid;
  std::vector<float> full_confidence_rays;  // N_K per layer, >= 1; FLOG.md section 3
  std::uint16_t min_rays = 8;               // a cell is "seen" from this N on; FLOG.md section 5
  bool operator==(const MapInfo&) const = default;
};

/// The whole map at one revision; cheap to copy, safe to read from any thread.
struct MapSnapshot {
  MapInfo info;
  std::uint64_t revision = 0;
  std::map<TileIndex, std::shared_ptr<const Tile>> tiles;
};

}  // namespace flogmap
