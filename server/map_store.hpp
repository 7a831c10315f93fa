// The map on disk: map.flog, one SQLite file. Layout and promises: docs/map-file.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/tile_update.hpp"
#include "server/publication.hpp"
#include "server/stored_view.hpp"

namespace flogmap {

/// All that a map file holds.
struct StoredMap {
  std::string epoch;  // 16 hex digits, lower case
  MapInfo info;
  StereoCamera camera;
  std::uint64_t revision = 0;
  std::vector<TileUpdate> tiles;            // in order of index, each index once, revisions <= `revision`
  std::vector<TrajectoryEntry> trajectory;  // in order of frames
  std::string options_json = "{}";          // the options it was made with
  std::string calibration_json = "{}";
  std::vector<SharedView> views;  // in order of number
  HandLevel level;                // by hand, since the automatic start
  /// The path was corrected and its writer ended before the tiles were built anew for it: they are those of
  /// the path before.
  bool behind = false;
};

/// The whole map of a file, checked to the last byte before anything is returned; nothing is written to it.
/// Throws std::runtime_error "FILE: what is wrong; what to do" if it is missing, no map, made by a newer
/// program, truncated, damaged or impossible. A store that is being written is read as of its last commit.
StoredMap load_map(const std::filesystem::path& path);

/// Writes the map as one file, all or nothing: beside the old file first, then in its place. Throws
/// std::runtime_error naming the file if that fails or a running program writes to that store, and
/// std::invalid_argument if the map contradicts itself (a tile of the wrong size, an impossible grid).
void save_map(const std::filesystem::path& path, const StoredMap& map);

/// Throws std::runtime_error saying which of cell size and layers differ and the way out.
void check_same_grid(const std::filesystem::path& path, const GridSpec& stored, const GridSpec& wanted);

/// The cells of a stored map without its path.
MapSnapshot snapshot_of(const StoredMap& map);

/// The live store of `serve --store`. One thread at a time; one process at a time, other processes may read.
/// Killed at any moment, the file holds what was last committed. Every call may throw std::runtime_error
/// naming the file; after a throw, call rollback(), and the store goes on from its last commit.
class MapStore {
 public:
  /// Opens a store or creates an empty one; throws if it is another program's file, damaged or in use. A map
  /// that is there and can only be read now, because the disk is full or read-only, can be loaded; what would
  /// write to it throws until the disk takes it.
  explicit MapStore(const std::filesystem::path& path);
  MapStore(MapStore&&) noexcept;
  MapStore& operator=(MapStore&&) noexcept;
  ~MapStore();  // what was not committed is dropped

  /// The map that the store holds, checked as by load_map(); nothing while none was begun and committed.
  [[nodiscard]] std::optional<StoredMap> load() const;

  /// False if viewers may have seen more than is stored: the last writer was killed, or this one might be
  /// before the disk lets it say that it writes.
  [[nodiscard]] bool ended_cleanly() const;

  /// The store holds this map from now on. A map of the same epoch goes on: its tiles and path stay, and
  /// what `map` knows better (newer tiles, a path of another length, info, options) replaces what is stored.
  void begin(const StoredMap& map);

  /// Tiles that are not newer than what is stored are skipped.
  void put_tiles(std::span<const TileUpdate> updates);
  void append_trajectory(std::span<const TrajectoryEntry> entries);
  void rewrite_trajectory(std::span<const TrajectoryEntry> entries);

  void put_level(const HandLevel& level);
  void set_behind(bool behind);  // see StoredMap

  /// Adds a view or replaces the one of this number.
  void put_view(const StoredView& view);
  [[nodiscard]] std::optional<StoredView> view(std::int64_t number) const;
  [[nodiscard]] std::vector<std::int64_t> view_numbers() const;

  /// Makes everything since the last commit durable at once, against loss of power too.
  void commit();
  /// Forgets everything since the last commit.
  void rollback();

  /// Revision of the map as it would be committed now; 0 without a map.
  [[nodiscard]] std::uint64_t revision() const;
  [[nodiscard]] const std::filesystem::path& path() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace flogmap
