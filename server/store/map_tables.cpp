#include "server/store/map_tables.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/store/map_rows.hpp"

namespace flogmap {
namespace {

std::int64_t as_signed(std::uint64_t value) { return static_cast<std::int64_t>(value); }

void check_pose(const SE3& pose) {
  if (!pose.matrix().allFinite()) throw std::invalid_argument("a pose must be finite to be stored");
}

}  // namespace

void MapTables::resume(const MapSeal& seal, int num_layers) {
  seal_ = seal;
  codec_.emplace(num_layers);
}

void MapTables::replace_all(const StoredMap& map) {
  check_header(map);
  database_.execute("DELETE FROM meta; DELETE FROM tiles; DELETE FROM trajectory; DELETE FROM views");
  write_header(database_, map);
  resume({.revision = map.revision, .clean = seal_.clean, .behind = map.behind}, map.info.grid.num_layers());
  put_tiles(map.tiles);
  append_trajectory(map.trajectory);
  for (const SharedView& view : map.views) put_view(*view);
}

void MapTables::carry_on(const StoredMap& map) {
  write_header(database_, map);
  seal_.revision = std::max(seal_.revision, map.revision);
  seal_.behind = map.behind;
  put_tiles(map.tiles);
  if (map.trajectory.size() != seal_.num_poses) rewrite_trajectory(map.trajectory);
}

void MapTables::put_tiles(std::span<const TileUpdate> updates) {
  SqliteStatement find = database_.prepare("SELECT revision, checksum FROM tiles WHERE x = ? AND y = ?");
  SqliteStatement put = database_.prepare(
      "INSERT OR REPLACE INTO tiles (x, y, revision, cells, checksum) VALUES (?, ?, ?, ?, ?)");
  for (const TileUpdate& update : updates) {
    find.reset();
    find.bind(1, std::int64_t{update.index.x}).bind(2, std::int64_t{update.index.y});
    if (find.step()) {
      if (find.integer(0) >= as_signed(update.revision)) continue;
      seal_.tiles_sum -= static_cast<std::uint64_t>(find.integer(1));
    } else {
      ++seal_.num_tiles;
    }
    const auto cells = codec_.value().encode(*update.tile);
    const std::uint64_t checksum = tile_checksum(update.index, update.revision, cells);
    put.bind(1, std::int64_t{update.index.x}).bind(2, std::int64_t{update.index.y});
    put.bind(3, as_signed(update.revision)).bind(4, cells).bind(5, as_signed(checksum)).run();
    seal_.tiles_sum += checksum;
    seal_.revision = std::max(seal_.revision, update.revision);
  }
}

void MapTables::append_trajectory(std::span<const TrajectoryEntry> entries) {
  SqliteStatement put = database_.prepare(
      "INSERT INTO trajectory (number, timestamp_ns, pose, state, mapped, checksum) VALUES (?, ?, ?, ?, ?, "
      "?)");
  for (const TrajectoryEntry& entry : entries) {
    check_pose(entry.world_from_camera);
    const auto pose = pose_bytes(entry.world_from_camera);
    const std::uint64_t checksum = pose_checksum(seal_.num_poses, entry);
    put.bind(1, as_signed(seal_.num_poses)).bind(2, entry.timestamp_ns).bind(3, pose);
    put.bind(4, static_cast<std::int64_t>(entry.state)).bind(5, std::int64_t{entry.mapped});
    put.bind(6, as_signed(checksum)).run();
    ++seal_.num_poses;
    seal_.poses_sum += checksum;
  }
}

void MapTables::rewrite_trajectory(std::span<const TrajectoryEntry> entries) {
  database_.execute("DELETE FROM trajectory");
  seal_.num_poses = 0;
  seal_.poses_sum = 0;
  append_trajectory(entries);
}

void MapTables::put_view(const StoredView& view) {
  check_pose(view.world_from_camera);
  SqliteStatement find = database_.prepare("SELECT checksum FROM views WHERE number = ?");
  find.bind(1, view.number);
  if (find.step()) {
    seal_.views_sum -= static_cast<std::uint64_t>(find.integer(0));
  } else {
    ++seal_.num_views;
  }
  find.reset();
  const auto pose = pose_bytes(view.world_from_camera);
  const std::uint64_t checksum = view_checksum(view);
  SqliteStatement put = database_.prepare(
      "INSERT OR REPLACE INTO views (number, timestamp_ns, pose, codec, data, checksum) "
      "VALUES (?, ?, ?, ?, ?, ?)");
  put.bind(1, view.number).bind(2, view.timestamp_ns).bind(3, pose).bind(4, std::int64_t{view.codec});
  put.bind(5, view.bytes).bind(6, as_signed(checksum)).run();
  seal_.views_sum += checksum;
}

void MapTables::put_level(const HandLevel& level) { write_level(database_, level); }

void MapTables::write_seal() const { flogmap::write_seal(database_, seal_); }

}  // namespace flogmap
