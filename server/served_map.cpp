#include "server/served_map.hpp"

#include <algorithm>
#include <utility>

namespace flogmap {

ServedMap::ServedMap(std::string id, MapBegin begin, Operators operators)
    : id_(std::move(id)),
      epoch_(std::move(begin.epoch)),
      camera_(begin.camera),
      revision_(begin.revision),
      board_(std::move(begin.info), operators),
      trajectory_(std::move(begin.trajectory)) {
  board_.update(begin.tiles);
  for (SharedView& view : begin.views) views_.add(std::move(view));
}

MapHeader ServedMap::header() const {
  return {epoch_, revision_, board_.info(), board_.operators(), board_.bounds(), camera_};
}

std::shared_ptr<const MapSnapshot> ServedMap::snapshot() {
  if (!snapshot_) {
    snapshot_ = std::make_shared<const MapSnapshot>(MapSnapshot{board_.info(), revision_, board_.tiles()});
  }
  return snapshot_;
}

std::vector<Slot> ServedMap::update(std::uint64_t revision, const std::vector<TileUpdate>& tiles) {
  revision_ = std::max(revision_, revision);
  snapshot_.reset();
  return board_.update(tiles);
}

void ServedMap::append(const TrajectoryEntry& entry) {
  trajectory_.push_back(entry);
  ++path_version_;
}

void ServedMap::add(const SharedView& view) {
  views_.add(view);
  ++path_version_;
}

void ServedMap::rewrite(std::vector<TrajectoryEntry> trajectory) {
  if (!trajectory.empty()) {
    const auto later = std::find_if(
        trajectory_.begin(), trajectory_.end(),
        [&](const TrajectoryEntry& entry) { return entry.timestamp_ns > trajectory.back().timestamp_ns; });
    trajectory.insert(trajectory.end(), later, trajectory_.end());
  }
  trajectory_ = std::move(trajectory);
  latest_part_ = {};
  rewritten_ = true;
  ++path_version_;
}

Bytes ServedMap::tile_batch(std::uint64_t revision, bool complete, std::span<const Slot> slots,
                            const TileChoice& choice) {
  Batch batch{revision, complete, {slots.begin(), slots.end()}, {}, choice, {}};
  for (const Slot slot : slots) batch.revisions.push_back(board_.revision(slot));
  for (const Batch& made : batches_) {
    const bool same = made.bytes && made.revision == revision && made.complete == complete &&
                      made.slots == batch.slots && made.revisions == batch.revisions && made.choice == choice;
    if (same) return made.bytes;
  }
  std::vector<Bytes> tiles;
  std::vector<TileKey> removed;
  for (const Slot slot : slots) {
    if (board_.exists(slot)) {
      tiles.push_back(board_.message(slot, choice));
    } else {
      removed.push_back(board_.key(slot));
    }
  }
  batch.bytes = to_shared(encode_tile_batch(revision, complete, tiles, removed));
  Batch& place = batches_[oldest_batch_++ % batches_.size()];
  place = std::move(batch);
  return place.bytes;
}

Bytes ServedMap::trajectory_message(std::size_t first, std::size_t count, const std::string* rewrite_reason) {
  const bool rewrite = rewrite_reason != nullptr;
  TrajectoryPart& part = latest_part_;
  if (part.bytes && part.first == first && part.count == count && part.rewrite == rewrite) return part.bytes;
  const std::span<const TrajectoryEntry> points(trajectory_.data() + first, count);
  std::string bytes =
      rewrite ? encode_trajectory_rewrite(points, *rewrite_reason) : encode_trajectory_append(first, points);
  part = {first, count, rewrite, to_shared(std::move(bytes))};
  return part.bytes;
}

}  // namespace flogmap
