#include "server/wire_values.hpp"

#include <array>
#include <cstdio>

namespace flogmap {

std::string layer_name(const GridSpec& grid, int layer) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.2f-%.2f m", grid.layer_bounds_m[layer],
                grid.layer_bounds_m[layer + 1]);
  return text.data();
}

std::string_view name_of(SessionState state) {
  switch (state) {
    case SessionState::starting:
      return "starting";
    case SessionState::running:
      return "running";
    case SessionState::paused:
      return "paused";
    case SessionState::finished:
      return "finished";
    case SessionState::failed:
      return "failed";
    case SessionState::stored:
      return "stored";
    case SessionState::draining:
      return "draining";
  }
  return "unknown";
}

std::string_view name_of(TrackingState state) {
  switch (state) {
    case TrackingState::initialising:
      return "initialising";
    case TrackingState::ok:
      return "ok";
    case TrackingState::weak:
      return "weak";
    case TrackingState::lost:
      return "lost";
  }
  return "unknown";
}

v1::TrackingState to_proto(TrackingState state) {
  switch (state) {
    case TrackingState::ok:
      return v1::TRACKING_STATE_OK;
    case TrackingState::weak:
      return v1::TRACKING_STATE_WEAK;
    case TrackingState::lost:
      return v1::TRACKING_STATE_LOST;
    case TrackingState::initialising:
      break;
  }
  return v1::TRACKING_STATE_INITIALISING;
}

namespace {

v1::Operators to_proto(Operators operators) {
  switch (operators) {
    case Operators::minmax:
      return v1::OPERATORS_MINMAX;
    case Operators::lukasiewicz:
      return v1::OPERATORS_LUKASIEWICZ;
    case Operators::algebraic:
      break;
  }
  return v1::OPERATORS_ALGEBRAIC;
}

void fill_layers(v1::MapInfo& to, const MapInfo& info) {
  for (int k = 0; k < info.grid.num_layers(); ++k) {
    v1::Layer& layer = *to.add_layers();
    layer.set_id(static_cast<std::uint32_t>(k));
    layer.set_name(layer_name(info.grid, k));
    layer.set_z_min(info.grid.layer_bounds_m[k]);
    layer.set_z_max(info.grid.layer_bounds_m[k + 1]);
    layer.set_full_confidence_rays(static_cast<double>(info.full_confidence_rays[k]));
  }
}

}  // namespace

void fill(v1::TileKey& to, TileKey from) {
  to.set_level(from.level);
  to.set_x(from.x);
  to.set_y(from.y);
}

void fill(v1::PoseValue& to, const SE3& world_from_camera) {
  const Eigen::Vector3d position = world_from_camera.translation();
  const Eigen::Quaterniond q(world_from_camera.rotation());
  to.set_x(position.x());
  to.set_y(position.y());
  to.set_z(position.z());
  to.set_qx(q.x());
  to.set_qy(q.y());
  to.set_qz(q.z());
  to.set_qw(q.w());
}

void fill(v1::TrajectoryPoint& to, const TrajectoryEntry& from) {
  to.set_time_ns(from.timestamp_ns);
  fill(*to.mutable_pose(), from.world_from_camera);
  to.set_state(to_proto(from.state));
  to.set_mapped(from.mapped);
}

void fill(v1::CameraModel& to, const StereoCamera& from) {
  to.set_focal_px(from.focal_px);
  to.set_cx_px(from.cx_px);
  to.set_cy_px(from.cy_px);
  to.set_baseline_m(from.baseline_m);
  to.set_width_px(static_cast<std::uint32_t>(from.width_px));
  to.set_height_px(static_cast<std::uint32_t>(from.height_px));
}

void fill(v1::MapInfo& to, const MapHeader& from) {
  to.set_epoch(from.epoch);
  to.set_rev(from.revision);
  to.set_cell_size(from.info.grid.cell_size_m);
  to.set_tile_size(kTileSide);
  to.set_levels(kOverviewLevels);
  fill_layers(to, from.info);
  if (from.bounds) {
    to.mutable_bounds()->set_x_min(from.bounds->x_min);
    to.mutable_bounds()->set_y_min(from.bounds->y_min);
    to.mutable_bounds()->set_x_max(from.bounds->x_max);
    to.mutable_bounds()->set_y_max(from.bounds->y_max);
  }
  to.set_min_rays(from.info.min_rays);
  to.set_operators(to_proto(from.operators));
}

}  // namespace flogmap
