// The rows of the table `meta`: JSON texts, each with its checksum.
#pragma once

#include <cstdint>

#include "server/map_store.hpp"
#include "server/store/sqlite.hpp"

namespace flogmap {

/// What the tables must add up to. A row has a checksum of its own; sums of them, modulo 2^64, tell that no
/// row is missing, doubled or from an older state.
struct MapSeal {
  std::uint64_t revision = 0;
  std::uint64_t num_tiles = 0, tiles_sum = 0;
  std::uint64_t num_poses = 0, poses_sum = 0;
  std::uint64_t num_views = 0, views_sum = 0;
  bool clean = true;    // the writer closed the store itself
  bool behind = false;  // the tiles are those of the path before its last correction
  bool operator==(const MapSeal&) const = default;
};

/// Throws std::invalid_argument naming the field if epoch, grid, N_K or camera is impossible.
void check_header(const StoredMap& map);

/// Writes all of a map but its tables: what it is, with which options and calibration.
void write_header(const SqliteDatabase& database, const StoredMap& map);
void write_level(const SqliteDatabase& database, const HandLevel& level);
void write_seal(const SqliteDatabase& database, const MapSeal& seal);

/// False for a store in which no map was begun yet.
bool has_header(const SqliteDatabase& database);
/// A map without tiles and path; throws std::runtime_error if anything in it is damaged or impossible.
StoredMap read_header(const SqliteDatabase& database);
MapSeal read_seal(const SqliteDatabase& database);

}  // namespace flogmap
