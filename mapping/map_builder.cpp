#include "mapping/map_builder.hpp"

#include <utility>

namespace flogmap {
namespace {

/// Puts the view where the correction says; false if its place is unknown.
bool place(View& view, const PathCorrection& correction) {
  const std::optional<SE3> map_from_odometry = correction.map_from_odometry(view.timestamp_ns, view.segment);
  if (map_from_odometry) view.world_from_camera = *map_from_odometry * view.world_from_camera;
  return map_from_odometry.has_value();
}

}  // namespace

MapBuilder::MapBuilder(MapIntegrator map, const MapBuilderOptions& options)
    : options_(options),
      map_(std::move(map)),
      frozen_(map_),
      frozen_holds_(!map_.snapshot().tiles.empty()),
      views_(options.max_view_bytes) {}

std::vector<TileUpdate> MapBuilder::add(View& view) {
  round_disparity(view.disparity);
  if (options_.keep_views) views_.add(view);
  while (views_.is_full()) freeze_oldest();
  if (place(view, correction_)) return map_.integrate(view);
  ++num_waiting_;
  return {};
}

void MapBuilder::correct(PathCorrection correction) {
  correction_ = std::move(correction);
  if (!options_.keep_views) return;
  ++corrected_times_;
  count_waiting();
}

void MapBuilder::count_waiting() {
  num_waiting_ = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const bool placed = correction_.map_from_odometry(views_.timestamp_ns(i), views_.segment(i)).has_value();
    num_waiting_ += placed ? 0 : 1;
  }
}

std::vector<TileUpdate> MapBuilder::catch_up() {
  if (!is_behind()) return {};
  if (!rebuild_) rebuild_ = Rebuild{frozen_, correction_, corrected_times_, 0};
  if (rebuild_->next < views_.size()) {
    View view = views_.view(rebuild_->next++);
    if (place(view, rebuild_->correction)) rebuild_->map.integrate(view);
  }
  if (rebuild_->next < views_.size()) return {};
  built_with_ = rebuild_->with;
  const Rebuild done = *std::exchange(rebuild_, std::nullopt);
  return map_.replace_by(done.map.snapshot());
}

/// The oldest view stays for good where it is now known to be.
void MapBuilder::freeze_oldest() {
  View oldest = views_.view(0);
  views_.drop_oldest();
  if (rebuild_ && rebuild_->next == 0) {
    View again = oldest;
    if (place(again, rebuild_->correction)) rebuild_->map.integrate(again);
  } else if (rebuild_) {
    --rebuild_->next;
  }
  if (place(oldest, correction_)) {
    frozen_.integrate(oldest);
    frozen_holds_ = true;
  } else {
    --num_waiting_;  // its place was never found
  }
}

void MapBuilder::reset() {
  map_.reset();
  frozen_.reset();
  frozen_holds_ = false;
  views_.clear();
  correction_ = {};
  built_with_ = corrected_times_;
  num_waiting_ = 0;
  rebuild_.reset();
}

}  // namespace flogmap
