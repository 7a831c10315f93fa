#include "tests/server/tile_mirror.hpp"

#include <algorithm>
#include <stdexcept>

#include "flogmap/v1/stream.pb.h"

namespace flogmap {
namespace {

TileKey key_of(const v1::TileKey& key) { return {key.level(), key.x(), key.y()}; }

std::string text(TileKey key) {
  return std::to_string(key.level) + "/" + std::to_string(key.x) + "/" + std::to_string(key.y);
}

}  // namespace

TileMirror::Effect TileMirror::take(std::string_view bytes) {
  v1::ServerMessage message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    throw std::runtime_error("no ServerMessage");
  switch (message.message_case()) {
    case v1::ServerMessage::kWelcome:
      if (epoch_.empty()) epoch_ = message.welcome().map().epoch();
      return Effect::welcome;
    case v1::ServerMessage::kReset:
      tiles_.clear();
      forgotten_.clear();
      path_ns_.clear();
      complete_revision_ = 0;
      epoch_ = message.reset().map().epoch();
      return Effect::reset;
    case v1::ServerMessage::kSnapshotBegin:
      return Effect::snapshot_begin;
    case v1::ServerMessage::kSnapshotEnd:
      complete_revision_ = std::max(complete_revision_, message.snapshot_end().rev());
      return Effect::snapshot_end;
    case v1::ServerMessage::kTrajectoryRewrite:
      path_ns_.clear();
      for (const auto& point : message.trajectory_rewrite().points()) path_ns_.push_back(point.time_ns());
      return Effect::other;
    case v1::ServerMessage::kTrajectoryAppend:
      if (message.trajectory_append().first() != path_ns_.size())
        throw std::runtime_error("a gap in the path");
      for (const auto& point : message.trajectory_append().points()) path_ns_.push_back(point.time_ns());
      return Effect::other;
    case v1::ServerMessage::kImageFrame:
      batch_bytes_ += bytes.size();
      return Effect::other;
    case v1::ServerMessage::kGoodbye:
      return Effect::goodbye;
    case v1::ServerMessage::kTileBatch:
      break;
    default:
      return Effect::other;
  }
  batch_bytes_ += bytes.size();
  for (const auto& tile : message.tile_batch().tiles()) {
    Tile& newest = tiles_[key_of(tile.key())];
    forgotten_.erase(key_of(tile.key()));
    if (newest.revision <= tile.rev()) newest = {tile.rev(), tile.SerializeAsString()};
  }
  for (const auto& key : message.tile_batch().removed()) {
    tiles_.erase(key_of(key));
    forgotten_.erase(key_of(key));
  }
  if (message.tile_batch().complete()) {
    complete_revision_ = std::max(complete_revision_, message.tile_batch().rev());
  }
  return Effect::tiles;
}

void TileMirror::forget(const std::vector<TileKey>& keys) {
  for (const TileKey& key : keys) {
    tiles_.erase(key);
    forgotten_.insert(key);
  }
}

std::string difference(const TileMirror& mirror, ServedMap& map, const TileChoice& choice) {
  TileBoard& board = map.board();
  std::size_t num_existing = 0;
  for (Slot slot = 0; slot < board.num_slots(); ++slot) {
    const TileKey key = board.key(slot);
    const auto held = mirror.tiles().find(key);
    if (!board.exists(slot) || mirror.forgotten().count(key) > 0) {
      if (held != mirror.tiles().end()) return "has " + text(key) + ", which does not exist or was forgotten";
      continue;
    }
    ++num_existing;
    if (held == mirror.tiles().end()) return "lacks " + text(key);
    if (held->second.revision != board.revision(slot)) return "has an old " + text(key);
    if (held->second.bytes != *board.message(slot, choice)) return "has other bytes of " + text(key);
  }
  if (num_existing != mirror.tiles().size()) return "has tiles that the map never had";
  std::vector<std::int64_t> path_ns;
  for (const TrajectoryEntry& entry : map.trajectory()) path_ns.push_back(entry.timestamp_ns);
  return path_ns == mirror.path_ns() ? "" : "has another path";
}

}  // namespace flogmap
