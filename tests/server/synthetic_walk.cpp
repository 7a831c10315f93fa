#include "tests/server/synthetic_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flogmap {
namespace {

constexpr double kRangeM = 5, kFieldOfViewRad = 1.4, kStepM = 0.02;
constexpr float kFullConfidence = 60;
constexpr int kRaysPerView = 240;

/// A wall or a piece of furniture: a box from the floor to `height_m`.
struct Box {
  double x_min, y_min, x_max, y_max, height_m;
};

constexpr std::array<Box, 10> kHouse{{{-6.1, -4.1, 6.1, -4.0, 2.5},
                                      {-6.1, 4.0, 6.1, 4.1, 2.5},
                                      {-6.1, -4.1, -6.0, 4.1, 2.5},
                                      {6.0, -4.1, 6.1, 4.1, 2.5},
                                      {-1.5, -0.8, 1.5, 0.8, 0.75},
                                      {-5.9, 2.6, -4.6, 3.9, 2.0},
                                      {4.2, -3.9, 5.9, -3.2, 0.9},
                                      {-0.05, 2.9, 0.05, 4.0, 2.5},
                                      {2.2, 3.2, 3.6, 3.9, 1.6},
                                      {-3.4, -3.9, -2.6, -3.3, 1.2}}};

/// Distance to the first box of at least this height along a ray; infinity if there is none.
double range_m(double x, double y, double direction_rad, double height_m) {
  const double dx = std::cos(direction_rad), dy = std::sin(direction_rad);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Box& box : kHouse) {
    if (box.height_m < height_m) continue;
    const double tx0 = (box.x_min - x) / dx, tx1 = (box.x_max - x) / dx;
    const double ty0 = (box.y_min - y) / dy, ty1 = (box.y_max - y) / dy;
    const double enter = std::max(std::min(tx0, tx1), std::min(ty0, ty1));
    const double leave = std::min(std::max(tx0, tx1), std::max(ty0, ty1));
    if (enter <= leave && leave > 0 && enter > 0) nearest = std::min(nearest, enter);
  }
  return nearest;
}

std::uint16_t merged(std::uint16_t before, std::uint16_t rays, float seen) {
  const float mean = (static_cast<float>(rays) * static_cast<float>(before) / kMembershipScale + seen) /
                     static_cast<float>(rays + 1);
  return static_cast<std::uint16_t>(std::lround(std::clamp(mean, 0.0F, 1.0F) * kMembershipScale));
}

}  // namespace

SyntheticWalk::SyntheticWalk(std::uint32_t seed) : random_(seed) {
  info_.full_confidence_rays.assign(static_cast<std::size_t>(info_.grid.num_layers()), kFullConfidence);
  camera_ = {435, 376, 240, 0.11, 752, 480};
}

MapBegin SyntheticWalk::begin(const std::string& epoch, const std::string& reason) const {
  MapBegin begin;
  begin.epoch = epoch;
  begin.info = info_;
  begin.camera = camera_;
  begin.reason = reason;
  return begin;
}

SyntheticWalk::Place SyntheticWalk::place() const {
  const double phase = 2 * M_PI * static_cast<double>(num_steps_) / kStepsPerRound;
  const double x = 3.9 * std::cos(phase), y = 2.1 * std::sin(phase);
  return {x, y, std::atan2(2.1 * std::cos(phase), -3.9 * std::sin(phase)) + 0.5 * std::sin(5 * phase)};
}

std::vector<TileUpdate> SyntheticWalk::step() {
  constexpr std::uint64_t kStepsPerView = 4;
  if (num_steps_++ % kStepsPerView != 0) return {};
  const Place at = place();
  touched_.clear();
  std::uniform_real_distribution<double> jitter(-0.5, 0.5);
  for (int ray = 0; ray < kRaysPerView; ++ray) {
    const double share = (ray + jitter(random_)) / kRaysPerView - 0.5;
    for (int layer = 0; layer < info_.grid.num_layers(); ++layer) {
      see(at, at.heading_rad + share * kFieldOfViewRad, layer);
    }
  }
  ++revision_;
  std::vector<TileUpdate> updates;
  for (const auto& [index, touched] : touched_) {
    tiles_[index].revision = revision_;
    updates.push_back({index, revision_, std::make_shared<const Tile>(tiles_[index])});
  }
  return updates;
}

void SyntheticWalk::see(const Place& from, double direction_rad, int layer) {
  const double z_m = info_.grid.layer_bounds_m[layer] + 0.3;
  const double l = range_m(from.x_m, from.y_m, direction_rad, z_m);
  const double w = 0.06;
  const double end = std::min(l + w, kRangeM);
  const double dx = std::cos(direction_rad), dy = std::sin(direction_rad);
  for (double r = 0.3; r < end; r += kStepM) {
    const double before = (l - r) / w;
    const float E = before >= 1 ? 1.0F : static_cast<float>(std::max(0.0, before));
    const float O = before >= 1 ? 0.0F : static_cast<float>(std::max(0.0, 1 - std::abs(before)));
    add(from.x_m + r * dx, from.y_m + r * dy, layer, E, O);
  }
}

void SyntheticWalk::add(double x_m, double y_m, int layer, float mu_E, float mu_O) {
  const CellIndex index = cell_at(info_.grid, x_m, y_m);
  Tile& tile = tiles_[tile_of(index)];
  if (tile.cells.empty()) tile.cells.resize(static_cast<std::size_t>(info_.grid.num_layers()) * kTileColumns);
  touched_[tile_of(index)] = true;
  Cell& cell = tile.cells[static_cast<std::size_t>(layer) * kTileColumns + column_in_tile(index)];
  const std::uint16_t O_before = cell.occupied;
  cell.empty = merged(cell.empty, cell.rays, mu_E);
  cell.occupied = merged(cell.occupied, cell.rays, mu_O);
  cell.change = static_cast<std::uint16_t>(std::max(std::abs(cell.occupied - O_before), cell.change * 7 / 8));
  cell.rays = static_cast<std::uint16_t>(std::min(cell.rays + 1, 180));
}

TrackingReport SyntheticWalk::tracking() {
  const Place at = place();
  TrackingReport report;
  report.timestamp_ns = static_cast<std::int64_t>(num_steps_) * 50'000'000;
  Eigen::Matrix3d world_from_camera;  // camera: x right, y down, z forward
  const double c = std::cos(at.heading_rad), s = std::sin(at.heading_rad);
  world_from_camera << s, 0, c, -c, 0, s, 0, -1, 0;
  SE3 pose = SE3::Identity();
  pose.linear() = world_from_camera;
  pose.translation() =
      Eigen::Vector3d(at.x_m, at.y_m, 1.2 + 0.03 * std::sin(0.4 * static_cast<double>(num_steps_)));
  const bool weak = num_steps_ % 400 > 385;
  report.world_from_camera = pose;
  report.tracking.state = weak ? TrackingState::weak : TrackingState::ok;
  report.tracking.reason = weak ? "few corners (31 of 40 wanted)" : "";
  report.tracking.covariance = Covariance6::Identity() * 1e-4;
  std::uniform_real_distribution<float> x_px(0, 751), y_px(0, 479), d_px(-4, 4);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2f current(x_px(random_), y_px(random_));
    report.tracking.matches.push_back(
        {Eigen::Vector2f(current.x() + d_px(random_), current.y()), current, 20, i % 5 != 0});
  }
  report.mapped = num_steps_ % 4 == 1;
  report.latency_ms = 18;
  return report;
}

PictureReport SyntheticWalk::pictures() const {
  auto frame = std::make_shared<RectifiedFrame>();
  auto disparity = std::make_shared<DisparityImage>();
  frame->left = frame->right = Image<std::uint8_t>(camera_.width_px, camera_.height_px, 30);
  disparity->px = Image<float>(camera_.width_px, camera_.height_px, std::numeric_limits<float>::quiet_NaN());
  const Place at = place();
  for (int x = 0; x < camera_.width_px; ++x) {
    const double angle = std::atan2(camera_.cx_px - x, camera_.focal_px);
    const double depth = range_m(at.x_m, at.y_m, at.heading_rad + angle, 0.5) * std::cos(angle);
    const double d = camera_.focal_px * camera_.baseline_m / depth;
    const int half = std::min(220, static_cast<int>(camera_.focal_px / depth));
    for (int y = 240 - half; y < 240 + half; ++y) {
      frame->left.at(x, y) = static_cast<std::uint8_t>(60 + std::min(180.0, 3 * d) + ((x ^ y) & 8));
      frame->right.at(x, y) = static_cast<std::uint8_t>(60 + std::min(180.0, 3 * d) + ((x ^ y) & 4));
      if ((x * 7 + y * 3) % 19 != 0) disparity->px.at(x, y) = static_cast<float>(d);
    }
  }
  PictureReport report;
  report.timestamp_ns = static_cast<std::int64_t>(num_steps_) * 50'000'000;
  report.frame = frame;
  report.disparity = disparity;
  return report;
}

StatusReport SyntheticWalk::status() const {
  StatusReport status;
  status.frames_per_s = 20;
  status.frames = status.tracked = num_steps_;
  status.mapped_views = revision_;
  status.stages = {{"read", 1.1, 2.0},
                   {"rectify", 3.2, 4.1},
                   {"disparity", 12.5, 16.0},
                   {"odometry", 8.4, 13.1},
                   {"map", 9.9, 15.2}};
  status.alignment = "given";
  if (num_steps_ % 400 > 300) status.warnings = {"too dark: open the aperture or add light"};
  return status;
}

}  // namespace flogmap
