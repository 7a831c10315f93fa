// Writing the tables of a map, with their seal kept right. Knows nothing of transactions.
#pragma once

#include <optional>
#include <span>

#include "server/map_store.hpp"
#include "server/store/map_meta.hpp"
#include "server/store/sqlite.hpp"
#include "server/store/tile_blob.hpp"

namespace flogmap {

class MapTables {
 public:
  explicit MapTables(SqliteDatabase& database) : database_(database) {}

  /// Throws away what is there and writes this map.
  void replace_all(const StoredMap& map);
  /// See MapStore::begin() for a map of the same epoch.
  void carry_on(const StoredMap& map);
  void put_tiles(std::span<const TileUpdate> updates);
  void append_trajectory(std::span<const TrajectoryEntry> entries);
  void rewrite_trajectory(std::span<const TrajectoryEntry> entries);
  void put_view(const StoredView& view);
  void put_level(const HandLevel& level);
  /// To be called last before a commit.
  void write_seal() const;

  /// Reads what is stored already; the layers tell how long a tile is.
  void resume(const MapSeal& seal, int num_layers);
  void set_clean(bool clean) { seal_.clean = clean; }
  void set_behind(bool behind) { seal_.behind = behind; }
  [[nodiscard]] const MapSeal& seal() const { return seal_; }

 private:
  SqliteDatabase& database_;
  MapSeal seal_;
  std::optional<TileCodec> codec_;
};

}  // namespace flogmap
