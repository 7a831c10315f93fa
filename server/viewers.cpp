#include "server/viewers.hpp"

#include <algorithm>

namespace flogmap {

using std::chrono::duration_cast;
using std::chrono::steady_clock;

void Viewers::join(Viewer& viewer) {
  viewers_.insert(&viewer);
  state_.num_viewers = static_cast<std::uint32_t>(viewers_.size());
}

void Viewers::leave(Viewer& viewer) {
  viewers_.erase(&viewer);
  state_.num_viewers = static_cast<std::uint32_t>(viewers_.size());
}

void Viewers::map_changed(std::span<const Slot> slots) {
  for (Viewer* viewer : viewers_) viewer->protocol().outbox().changed(slots);
}

void Viewers::map_reset(const std::string& reason) {
  for (Viewer* viewer : viewers_) viewer->protocol().reset(reason);
}

void Viewers::trajectory_rewritten(const std::string& reason) {
  for (Viewer* viewer : viewers_) viewer->protocol().outbox().rewritten(reason);
}

void Viewers::tracked() {
  const TrackingReport& report = *state_.tracking;
  const Bytes pose = to_shared(encode_pose(report, report.latency_ms));
  Bytes features;
  for (Viewer* viewer : viewers_) {
    StreamProtocol& protocol = viewer->protocol();
    if (!protocol.outbox().wants_pose()) continue;
    protocol.outbox().pose(pose);
    if (!protocol.wants_features()) continue;
    if (!features) features = to_shared(encode_features(report));
    protocol.outbox().features(features);
  }
}

void Viewers::status_changed() {
  count_waiting();
  if (viewers_.empty()) return;
  const Bytes status = to_shared(encode_status(state_.status, state_.serving_status()));
  for (Viewer* viewer : viewers_) {
    if (viewer->protocol().greeted()) viewer->protocol().outbox().status(status);
  }
  playback_changed();
}

void Viewers::count_waiting() {
  state_.num_waiting_tiles = state_.most_waiting_tiles = 0;
  for (Viewer* viewer : viewers_) {
    const std::size_t waiting = viewer->protocol().outbox().num_pending();
    state_.num_waiting_tiles += waiting;
    state_.most_waiting_tiles = std::max(state_.most_waiting_tiles, waiting);
  }
}

void Viewers::playback_changed() {
  const Bytes playback = to_shared(encode_playback(state_.control.playback()));
  for (Viewer* viewer : viewers_) {
    if (viewer->protocol().greeted()) viewer->protocol().outbox().playback(playback);
  }
}

void Viewers::dismiss_all(const std::string& reason) {
  const std::set<Viewer*> all = viewers_;  // one that is broken may leave at once
  for (Viewer* viewer : all) viewer->dismiss(reason);
}

void Viewers::pump_all() {
  const std::set<Viewer*> all = viewers_;
  for (Viewer* viewer : all) viewer->pump();
}

std::set<PictureKey> Viewers::wanted_pictures(std::int64_t timestamp_ns, Time now) {
  std::set<PictureKey> wanted;
  for (Viewer* viewer : viewers_) {
    for (const ImageWish& wish : viewer->protocol().image_wishes()) {
      const bool holds_one = viewer->protocol().outbox().holds_image(wish.request.stream);
      if (now < wish.next || wish.last_ns == timestamp_ns || holds_one) continue;
      wanted.insert(picture_key(wish.request));
    }
  }
  return wanted;
}

bool Viewers::any_picture_wish() {
  return std::any_of(viewers_.begin(), viewers_.end(),
                     [](Viewer* viewer) { return !viewer->protocol().image_wishes().empty(); });
}

void Viewers::deliver_picture(PictureKey key, std::int64_t timestamp_ns, const Bytes& message, Time now) {
  for (Viewer* viewer : viewers_) {
    for (ImageWish& wish : viewer->protocol().image_wishes()) {
      if (now < wish.next || picture_key(wish.request) != key) continue;
      const auto interval = duration_cast<steady_clock::duration>(
          std::chrono::duration<double>(1.0 / std::clamp(wish.request.max_fps, 0.01, 1000.0)));
      wish.next = std::max(wish.next + interval, now);
      wish.last_ns = timestamp_ns;
      viewer->protocol().outbox().image(key.stream, message);
    }
  }
}

}  // namespace flogmap
