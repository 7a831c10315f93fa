#include "mapping/flog/fan_sums.hpp"

#include <algorithm>
#include <utility>

namespace flogmap {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 28;  // a membership of 1

std::int64_t fixed(float value) { return static_cast<std::int64_t>(value * static_cast<float>(kOne)); }

/// First column from `column` on, the one that holds rho_m, whose nearest point is not before rho_m.
int first_not_before(const FanLine& line, int column, float rho_m) {
  return column + (line.nearest_m(column) < rho_m ? 1 : 0);
}

}  // namespace

/// The ramps of a ray.
struct FanSums::Ramps {
  float begin_m, hit_m, end_m;  // rho at l - m, l, l + m
  std::int64_t slope;           // per metre
  std::int64_t at_0;            // of the ramp `met`, extended to rho = 0: -begin_m * slope

  explicit Ramps(const FanRay& ray)
      : begin_m(ray.hit_m - ray.width_m), hit_m(ray.hit_m), end_m(ray.hit_m + ray.width_m) {
    const float per_m = 1 / ray.width_m;
    slope = fixed(per_m);
    at_0 = -fixed(begin_m * per_m);
  }

  /// Both ramps at one point.
  [[nodiscard]] Change at(float rho_m) const {
    const float per_m = 1 / (end_m - hit_m);
    return {fixed(std::clamp((rho_m - begin_m) * per_m, 0.0F, 1.0F)), 0,
            fixed(std::clamp((rho_m - hit_m) * per_m, 0.0F, 1.0F)), 0};
  }
};

void FanSums::start(const FanLine& line, double camera_z_m) {
  bounds_m_.clear();
  for (const double z : grid_.layer_bounds_m) bounds_m_.push_back(static_cast<float>(z - camera_z_m));
  const std::size_t size = std::size_t(line.size()) + 1;
  for (Layer& layer : layers_) {
    if (layer.counts.size() < size) layer.counts.resize(size, 0);
    if (layer.changes.size() < size) layer.changes.resize(size);
    layer.first_change = line.size() + 1;
    layer.last_change = -1;
  }
}

void FanSums::add(const FanLine& line, const FanRay& ray) {
  const Ramps ramps(ray);
  float low = bounds_m_[0] * ray.run_per_rise;  // rho where the ray passes the lower bound of the layer
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const float high = bounds_m_[k + 1] * ray.run_per_rise;
    const float from = std::max(0.0F, std::min(low, high)), to = std::min(ray.end_m, std::max(low, high));
    if (from < to) add_stretch(line, ramps, layers_[k], from, to);
    low = high;
  }
}

void FanSums::add_stretch(const FanLine& line, const Ramps& ramps, Layer& layer, float from_m,
                          float to_m) const {
  const int first = line.column_at(from_m), last = line.column_at(to_m);
  ++layer.counts[first];
  --layer.counts[last + 1];
  if (to_m > ramps.begin_m) add_hit(line, ramps, layer, first, last, from_m, to_m);
}

void FanSums::add_hit(const FanLine& line, const Ramps& ramps, Layer& layer, int first, int last,
                      float from_m, float to_m) const {
  Change* changes = layer.changes.data();
  layer.last_change = std::max(layer.last_change, last + 1);
  const auto add_one_column = [&](int j, float rho_m) {
    const Change value = ramps.at(rho_m);
    changes[j].met += value.met, changes[j].passed += value.passed;
    changes[j + 1].met -= value.met, changes[j + 1].passed -= value.passed;
  };
  // In the first and last column the ray may not come as near to the axis as the line does.
  int begin = first, end = last + 1;
  if (line.nearest_m(first) < from_m) {
    layer.first_change = std::min(layer.first_change, first);
    add_one_column(begin++, from_m);
  }
  if (begin < end && line.nearest_m(last) > to_m) {
    layer.first_change = std::min(layer.first_change, last);
    add_one_column(--end, to_m);
  }
  if (begin >= end) return;
  const auto column_of = [&](float rho_m) {
    const int column = line.column_at(std::clamp(rho_m, from_m, to_m));
    return std::clamp(first_not_before(line, column, rho_m), begin, end);
  };
  const int met_from = column_of(ramps.begin_m);
  layer.first_change = std::min(layer.first_change, met_from);
  Change& met_begins = changes[met_from];
  met_begins.met += ramps.at_0;
  met_begins.met_slope += ramps.slope;
  Change& hit = changes[column_of(ramps.hit_m)];
  hit.met += kOne - ramps.at_0;
  hit.met_slope -= ramps.slope;
  hit.passed += ramps.at_0 - kOne;
  hit.passed_slope += ramps.slope;
  Change& passed_ends = changes[column_of(ramps.end_m)];
  passed_ends.passed += 2 * kOne - ramps.at_0;
  passed_ends.passed_slope -= ramps.slope;
  changes[end].met -= kOne;
  changes[end].passed -= kOne;
}

/// From whole numbers that are exact.
inline FanSums::Bundle FanSums::take_bundle(Layer& layer, int j, float rho_m) {
  layer.rays += std::exchange(layer.counts[j], 0);
  const auto rays = static_cast<std::uint64_t>(layer.rays);
  if (j < layer.first_change || j > layer.last_change) return {rays, rays * kEvidenceOne, 0};
  Change& ramps = layer.ramps;
  Change& change = layer.changes[j];
  ramps.met += change.met, ramps.met_slope += change.met_slope;
  ramps.passed += change.passed, ramps.passed_slope += change.passed_slope;
  change = Change{};
  if (rays == 0) return {};
  constexpr double kUnit = static_cast<double>(kEvidenceOne) / static_cast<double>(kOne);
  const double rho = rho_m, all = static_cast<double>(layer.rays) * kEvidenceOne;
  const auto value = [&](std::int64_t constant, std::int64_t slope) {
    return (static_cast<double>(constant) + static_cast<double>(slope) * rho) * kUnit;
  };
  const double met = std::clamp(value(ramps.met, ramps.met_slope), 0.0, all);
  const double passed = std::clamp(value(ramps.passed, ramps.passed_slope), 0.0, met);
  const auto met_sum = static_cast<std::uint64_t>(met + 0.5),
             passed_sum = static_cast<std::uint64_t>(passed + 0.5);
  return {rays, rays * kEvidenceOne - met_sum, met_sum - passed_sum};
}

inline void FanSums::give(const Bundle& bundle, int share, EvidenceSum& sum) {
  if (share == int{kWholeShare}) {
    sum.add(bundle.rays, bundle.empty, bundle.occupied);
  } else {
    sum.add_share(share, bundle.rays, bundle.empty, bundle.occupied);
  }
}

void FanSums::flush(const FanLine& line, const FanShares& shares, ViewEvidence& evidence) {
  for (Layer& layer : layers_) {
    layer.rays = 0;
    layer.ramps = Change{};
  }
  const auto give_to = [&](CellIndex cell, int share) {
    EvidenceSum* sums = evidence.column(cell);
    for (std::size_t k = 0; k < layers_.size(); ++k) give(bundles_[k], share, sums[k]);
  };
  FanShare share, before;
  for (int j = 0; j < line.size(); ++j, before = share) {
    std::uint64_t rays = 0;
    for (std::size_t k = 0; k < layers_.size(); ++k) {
      bundles_[k] = take_bundle(layers_[k], j, line.nearest_m(j));
      rays += bundles_[k].rays;
    }
    if (shares.any()) share = shares.at(j);
    if (rays == 0) continue;
    give_to(line.cell(j), share.own);
    if (share.counter != 0) give_to(shares.counter_of(line.cell(j)), share.counter);
    if (before.drift != 0) give_to(shares.drift_of(line.cell(j - 1)), before.drift);
  }
  for (Layer& layer : layers_) {
    layer.counts[line.size()] = 0;
    layer.changes[line.size()] = Change{};
  }
}

}  // namespace flogmap
