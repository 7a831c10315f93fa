#include "server/store/map_digest.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "server/store/checksum.hpp"
#include "server/store/map_rows.hpp"
#include "server/store/tile_blob.hpp"

namespace flogmap {
namespace {

bool is_blank(const Tile& tile) {
  return std::ranges::all_of(tile.cells, [](const Cell& cell) { return cell == Cell{}; });
}

void add_grid(const GridSpec& grid, Sha256& hash) {
  LittleEndianBytes bytes;
  bytes.add(grid.cell_size_m);
  for (const double bound_m : grid.layer_bounds_m) bytes.add(bound_m);
  hash.add(bytes.bytes());
}

void add_pose(const TrajectoryEntry& entry, Sha256& hash) {
  LittleEndianBytes key;
  key.add_signed(entry.timestamp_ns).add(std::uint64_t{static_cast<std::uint8_t>(entry.state)});
  hash.add(key.bytes()).add(pose_bytes(entry.world_from_camera));
}

}  // namespace

std::string map_digest(const MapSnapshot& map, std::span<const TrajectoryEntry> trajectory) {
  Sha256 hash;
  add_grid(map.info.grid, hash);
  std::vector<std::uint8_t> cells;
  for (const auto& [index, tile] : map.tiles) {
    if (is_blank(*tile)) continue;
    LittleEndianBytes key;
    hash.add(key.add_signed(index.x).add_signed(index.y).bytes());
    cells_to_bytes(tile->cells, cells);
    hash.add(cells);
  }
  for (const TrajectoryEntry& entry : trajectory) add_pose(entry, hash);
  return hash.hex();
}

std::string map_digest(const StoredMap& map) { return map_digest(snapshot_of(map), map.trajectory); }

}  // namespace flogmap
