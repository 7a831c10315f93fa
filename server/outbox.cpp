#include "server/outbox.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace flogmap {
namespace {

using std::chrono::duration_cast;
using std::chrono::nanoseconds;

constexpr std::size_t kSortedAhead = 256;  // more than a batch holds
constexpr std::uint64_t kTypicalLayerBytes = 1500;
constexpr std::size_t kTrajectoryEntryBytes = 80;

/// Between once an hour and 1000 Hz: the inverse of less is more nanoseconds than there are.
std::chrono::nanoseconds interval_of(double hz) {
  return duration_cast<nanoseconds>(std::chrono::duration<double>(1.0 / std::clamp(hz, 1.0 / 3600, 1000.0)));
}

}  // namespace

void Outbox::resume(const Resume& known, const ServedMap& map) {
  resumed_revision_ = known.revision;
  const bool same_path =
      !map.trajectory_was_rewritten() && known.trajectory_length <= map.trajectory().size();
  if (same_path) {
    trajectory_sent_ = known.trajectory_length;
  } else {
    rewritten("path changed while disconnected");
  }
}

void Outbox::subscribe(const Subscribe& wish, const ServedMap& map) {
  pose_interval_.reset();
  next_pose_ = {};
  if (wish.pose_hz > 0) pose_interval_ = interval_of(wish.pose_hz);
  if (!wish.features) features_ = nullptr;
  for (Bytes& image : images_) image = nullptr;
  if (subscribed_ && wish.tiles == choice_) return;
  if (subscribed_) resumed_revision_.reset();  // it has everything, but in other planes
  choice_ = wish.tiles;
  subscribed_ = true;
  begin_snapshot(map);
}

void Outbox::begin_snapshot(const ServedMap& map) {
  const TileBoard& board = map.board();
  needs_.resize(board.num_slots(), Need::none);
  std::uint64_t num_tiles = 0;
  for (Slot slot = 0; slot < board.num_slots(); ++slot) {
    const bool known = resumed_revision_ ? board.revision(slot) <= *resumed_revision_ : !board.exists(slot);
    if (known) continue;
    if (needs_[slot] != Need::round) need(slot);
    ++num_tiles;
  }
  const std::uint64_t num_layers =
      choice_.layers.empty() ? board.info().grid.num_layers() : choice_.layers.size();
  const std::uint64_t num_planes = choice_.planes == Planes::value ? 1 : 3;
  const std::uint64_t estimate = num_tiles * num_layers * num_planes * kTypicalLayerBytes / 2;
  control(to_shared(encode_snapshot_begin(num_tiles, estimate)));
  in_snapshot_ = true;
  next_round_ = {};
}

void Outbox::look_at(const Viewport& viewport, const ServedMap& map) {
  if (viewport_ == viewport) return;
  viewport_ = viewport;
  num_sorted_ = 0;
  for (Slot slot = 0; slot < needs_.size(); ++slot) {
    if (needs_[slot] == Need::forgotten && visible(map, slot)) need(slot);
  }
}

void Outbox::forget(const std::vector<TileKey>& keys, const ServedMap& map) {
  needs_.resize(map.board().num_slots(), Need::none);
  for (const TileKey& key : keys) {
    const auto slot = map.board().find(key);
    // One that waits to be sent stays: an older state of it may be on the line, and would be kept.
    if (!slot || needs_[*slot] != Need::none) continue;
    if (subscribed_ && visible(map, *slot)) {
      need(*slot);
    } else {
      needs_[*slot] = Need::forgotten;
    }
  }
}

bool Outbox::acknowledge(std::uint64_t bytes, Time now) { return window_.acknowledge(bytes, now); }

void Outbox::changed(std::span<const Slot> slots) {
  if (!subscribed_) return;  // the snapshot will have them
  for (const Slot slot : slots) {
    if (slot >= needs_.size()) needs_.resize(slot + 1, Need::none);
    if (needs_[slot] == Need::none || needs_[slot] == Need::forgotten) need(slot);
  }
}

void Outbox::need(Slot slot) {
  if (needs_[slot] == Need::waiting) return;
  needs_[slot] = Need::waiting;
  waiting_.push_back(slot);
}

void Outbox::rewritten(std::string reason) { rewrite_reason_ = std::move(reason); }

void Outbox::reset(const ServedMap& map) {
  needs_.clear();
  waiting_.clear();
  round_.clear();
  num_sorted_ = 0;
  resumed_revision_.reset();
  trajectory_sent_ = 0;
  rewrite_reason_.reset();
  pose_ = features_ = nullptr;
  if (subscribed_) begin_snapshot(map);
}

bool Outbox::control(Bytes message) {
  if (controls_.size() >= kMaxControls) return false;
  controls_.push_back(std::move(message));
  return true;
}

void Outbox::begin_round(const ServedMap& map, Time now) {
  if (waiting_.empty() && !(in_snapshot_ && round_.empty())) return;
  if (image_waits() && !round_.empty()) return;  // tiles that never end would never let it go
  if (now < next_round_) return;
  for (const Slot slot : waiting_) needs_[slot] = Need::round;
  round_.insert(round_.end(), waiting_.begin(), waiting_.end());
  waiting_.clear();
  num_sorted_ = 0;
  round_revision_ = map.revision();
  next_round_ = now + kChangeInterval;
}

bool Outbox::visible(const ServedMap& map, Slot slot) const {
  if (!viewport_) return false;
  const TileKey key = map.board().key(slot);
  return key.level == viewport_->level &&
         intersect(tile_bounds(map.board().info().grid, key), viewport_->bounds);
}

void Outbox::sort_round(const ServedMap& map) {
  const Bounds view = viewport_ ? viewport_->bounds : Bounds{};
  const double x = (view.x_min + view.x_max) / 2, y = (view.y_min + view.y_max) / 2;
  struct Candidate {
    bool unseen;
    double distance_squared;
    Slot slot;
    // Farthest first, so that the next one to send is at the back.
    bool operator<(const Candidate& other) const {
      return std::tie(unseen, distance_squared, slot) >
             std::tie(other.unseen, other.distance_squared, other.slot);
    }
  };
  std::vector<Candidate> candidates;
  candidates.reserve(round_.size());
  for (const Slot slot : round_) {
    const Bounds b = tile_bounds(map.board().info().grid, map.board().key(slot));
    const double dx = (b.x_min + b.x_max) / 2 - x, dy = (b.y_min + b.y_max) / 2 - y;
    candidates.push_back({!visible(map, slot), dx * dx + dy * dy, slot});
  }
  num_sorted_ = std::min(kSortedAhead, candidates.size());
  const auto ahead = candidates.end() - static_cast<std::ptrdiff_t>(num_sorted_);
  if (ahead != candidates.begin()) std::nth_element(candidates.begin(), ahead, candidates.end());
  std::sort(ahead, candidates.end());
  std::transform(candidates.begin(), candidates.end(), round_.begin(),
                 [](const Candidate& c) { return c.slot; });
}

Bytes Outbox::next(ServedMap& map, Time now) {
  if (Bytes message = next_control()) return message;
  if (Bytes message = next_pose(now)) return message;
  if (!subscribed_) return nullptr;
  if (Bytes message = next_trajectory(map, now)) return message;
  if (image_first()) return next_image(now);  // or wait until it fits
  if (Bytes message = next_tiles(map, now)) return message;
  if (Bytes message = next_control()) return message;  // the end of a snapshot without tiles
  return next_image(now);
}

Bytes Outbox::next_control() {
  if (controls_.empty()) return nullptr;
  Bytes message = std::move(controls_.front());
  controls_.pop_front();
  return message;
}

Bytes Outbox::next_pose(Time now) {
  if (pose_ && !pose_interval_) pose_ = nullptr;
  const bool behind = window_.behind(now);  // these are not acknowledged: nothing else would hold them back
  if (pose_ && now >= next_pose_) {
    next_pose_ += *pose_interval_;
    if (next_pose_ <= now) next_pose_ = now + *pose_interval_;
    if (behind) next_pose_ += kPosesSkippedBehind * *pose_interval_;
    return std::exchange(pose_, nullptr);
  }
  if (features_ && !pose_ && !behind) return std::exchange(features_, nullptr);
  if (status_) return std::exchange(status_, nullptr);
  return std::exchange(playback_, nullptr);
}

/// Of the size that the line takes at a time.
std::size_t Outbox::trajectory_part() const {
  return std::clamp<std::size_t>(window_.batch_bytes() / kTrajectoryEntryBytes, 1, kTrajectoryPart);
}

Bytes Outbox::next_trajectory(ServedMap& map, Time now) {
  const std::size_t length = map.trajectory().size(), part = trajectory_part();
  if (rewrite_reason_) {
    trajectory_sent_ = std::min(length, part);
    const std::string reason = *std::exchange(rewrite_reason_, std::nullopt);
    return map.trajectory_message(0, trajectory_sent_, &reason);
  }
  const std::size_t first = trajectory_sent_;
  if (first >= length) return nullptr;
  const std::size_t count = std::min(length - first, part);
  if (now < next_trajectory_ && count < part) return nullptr;
  next_trajectory_ = now + kTrajectoryInterval;
  trajectory_sent_ += count;
  return map.trajectory_message(first, count, nullptr);
}

Bytes Outbox::next_tiles(ServedMap& map, Time now) {
  begin_round(map, now);
  Bytes message;
  if (!round_.empty()) {
    if (!window_.open(now)) return nullptr;
    std::vector<Slot> slots;
    std::size_t size = 64;
    while (!round_.empty()) {
      if (num_sorted_ == 0) sort_round(map);
      const Slot slot = round_.back();
      size += map.board().exists(slot) ? map.board().message_size(slot, choice_) : 32;
      if (!slots.empty() && size > window_.batch_bytes()) break;
      slots.push_back(slot);
      needs_[slot] = Need::none;
      round_.pop_back();
      --num_sorted_;
    }
    // What changed meanwhile either was still to come in this round, and came as it now is, or waits.
    if (round_.empty() && waiting_.empty()) round_revision_ = map.revision();
    message = map.tile_batch(round_revision_, round_.empty(), slots, choice_);
    window_.sent(message->size(), now);
    round_done_ = round_done_ || round_.empty();
  }
  if (in_snapshot_ && round_.empty()) {
    in_snapshot_ = false;
    control(to_shared(encode_snapshot_end(round_revision_)));
  }
  return message;
}

bool Outbox::image_waits() const {
  return std::any_of(images_.begin(), images_.end(), [](const Bytes& image) { return image != nullptr; });
}

/// Tiles go before pictures, but those of one round only.
bool Outbox::image_first() const { return round_done_ && round_.empty() && !in_snapshot_ && image_waits(); }

Bytes Outbox::next_image(Time now) {
  for (Bytes& image : images_) {
    if (!image) continue;
    const bool fits = unacknowledged() + image->size() <= window_.bytes(now);
    if (!fits && unacknowledged() > 0) return nullptr;  // one that never fits goes alone
    window_.sent(image->size(), now);
    round_done_ = false;
    return std::exchange(image, nullptr);
  }
  return nullptr;
}

std::optional<Outbox::Time> Outbox::next_at(const ServedMap& map, Time now) const {
  std::optional<Time> earliest;
  const auto consider = [&](Time time) { earliest = earliest ? std::min(*earliest, time) : time; };
  if (pose_ && pose_interval_) consider(next_pose_);
  if (subscribed_ && trajectory_sent_ < map.trajectory().size()) consider(next_trajectory_);
  if (subscribed_ && !waiting_.empty() && window_.open(now) && !image_first()) consider(next_round_);
  if (!waiting_.empty() || !round_.empty() || image_waits()) {
    if (const auto time = window_.opens_at(now)) consider(*time);
  }
  return earliest;
}

std::size_t Outbox::memory_bytes() const {
  std::size_t bytes = needs_.capacity() + (waiting_.capacity() + round_.capacity()) * sizeof(Slot);
  bytes += window_.memory_bytes();
  for (const Bytes& message : controls_) bytes += message->size();
  for (const Bytes& message : {pose_, features_, status_, playback_}) bytes += message ? message->size() : 0;
  for (const Bytes& image : images_) bytes += image ? image->size() : 0;
  return bytes;
}

}  // namespace flogmap
