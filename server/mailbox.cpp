#include "server/mailbox.hpp"

#include <utility>

namespace flogmap {

template <typename Merge>
bool Mailbox::merge(Merge merge_into) {
  const std::lock_guard lock(mutex_);
  merge_into(contents_);
  return !std::exchange(woken_, true);
}

bool Mailbox::begin(MapBegin map) {
  return merge([&](Contents& contents) {
    contents.begin = std::move(map);
    contents.revision = 0;
    contents.tiles.clear();
    contents.rewrite.reset();
    contents.appended.clear();
    contents.views.clear();
    contents.tracking.reset();
  });
}

bool Mailbox::publish(std::uint64_t revision, std::vector<TileUpdate> tiles) {
  return merge([&](Contents& contents) {
    contents.revision = std::max(contents.revision, revision);
    for (TileUpdate& tile : tiles) {
      TileUpdate& newest = contents.tiles[tile.index];
      if (newest.revision <= tile.revision) newest = std::move(tile);
    }
  });
}

bool Mailbox::publish_view(SharedView view) {
  return merge([&](Contents& contents) { contents.views.push_back(std::move(view)); });
}

bool Mailbox::publish_tracking(TrackingReport report) {
  return merge([&](Contents& contents) {
    if (report.world_from_camera) {
      contents.appended.push_back(
          {report.timestamp_ns, *report.world_from_camera, report.tracking.state, report.mapped});
    }
    contents.tracking = std::move(report);
  });
}

bool Mailbox::publish_pictures(PictureReport report) {
  return merge([&](Contents& contents) { contents.pictures = std::move(report); });
}

bool Mailbox::publish_status(StatusReport report) {
  return merge([&](Contents& contents) { contents.status = std::move(report); });
}

bool Mailbox::rewrite_trajectory(std::vector<TrajectoryEntry> trajectory, std::string reason) {
  return merge([&](Contents& contents) {
    if (!trajectory.empty()) {
      const std::int64_t last_ns = trajectory.back().timestamp_ns;
      std::erase_if(contents.appended,
                    [=](const TrajectoryEntry& entry) { return entry.timestamp_ns <= last_ns; });
    }
    contents.rewrite = Rewrite{std::move(trajectory), std::move(reason)};
  });
}

bool Mailbox::set_calibration(std::string calibration_json) {
  return merge([&](Contents& contents) { contents.calibration_json = std::move(calibration_json); });
}

bool Mailbox::drain(std::string reason) {
  return merge([&](Contents& contents) { contents.drain_reason = std::move(reason); });
}

Mailbox::Contents Mailbox::take() {
  const std::lock_guard lock(mutex_);
  woken_ = false;
  return std::exchange(contents_, {});
}

}  // namespace flogmap
