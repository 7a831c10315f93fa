#pragma once

#include <cstdint>
#include <vector>

#include "server/hub.hpp"
#include "server/pipeline_observer.hpp"
#include "server/store/store_writer.hpp"
#include "server/views/view_keeper.hpp"

namespace flogmap {

/// Hands everything on to those who show it and to those who keep it.
class ServeObserver final : public PipelineObserver {
 public:
  void connect(Hub* hub, StoreWriter* store) {
    hub_ = hub;
    store_ = store;
  }

  void map_begins(const MapBegin& begin) override {
    path_ = begin.trajectory;
    keeper_.begin(begin.views);
    if (store_ != nullptr) store_->begin(begin);
    hub_->begin(begin);
  }
  void map_changed(std::uint64_t revision, const std::vector<TileUpdate>& updates) override {
    if (store_ != nullptr) store_->publish(updates);
    hub_->publish(revision, updates);
  }
  void view_mapped(const View& view) override {
    const SharedView kept = keeper_.keep(view);
    if (!kept) return;
    if (store_ != nullptr) store_->put_view(kept);
    hub_->publish_view(kept);
  }
  void path_grew(const std::vector<TrajectoryEntry>& entries) override {
    path_.insert(path_.end(), entries.begin(), entries.end());
    if (store_ != nullptr) store_->append_trajectory(entries);
    // The hub appends the poses of tracking reports itself. Only frames of the first seconds get theirs
    // later, all at once, when it is decided which way is up.
    if (entries.size() > 1 || entries.back().timestamp_ns != tracked_ns_) {
      hub_->rewrite_trajectory(path_, "levelled");
    }
  }
  void path_rewritten(const PathRewrite& rewrite) override {
    path_ = rewrite.path;
    if (store_ != nullptr) store_->rewrite_path(rewrite);
    hub_->rewrite_trajectory(path_, rewrite.reason);
  }
  void map_caught_up(std::uint64_t number) override {
    if (store_ != nullptr) store_->caught_up(number);
  }
  void frame_tracked(const TrackingReport& report) override {
    if (report.world_from_camera) tracked_ns_ = report.timestamp_ns;
    hub_->publish_tracking(report);
  }
  void pictures_taken(const PictureReport& report) override { hub_->publish_pictures(report); }
  void status_changed(const StatusReport& report) override {
    StatusReport with_store = report;
    if (store_ != nullptr) {
      const StoreState state = store_->state();
      if (!state.ok) with_store.warnings.push_back(state.problem);
    }
    hub_->publish_status(with_store);
  }

 private:
  Hub* hub_ = nullptr;
  StoreWriter* store_ = nullptr;
  std::vector<TrajectoryEntry> path_;
  ViewKeeper keeper_;             // map thread
  std::int64_t tracked_ns_ = -1;  // newest frame whose pose the hub has
};

}  // namespace flogmap
