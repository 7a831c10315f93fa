#include "mapping/flog/fan_sums.hpp"

#include <algorithm>

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
  stride_ = line.size() + 1;
  bounds_m_.clear();
  for (const double z : grid_.layer_bounds_m) bounds_m_.push_back(static_cast<float>(z - camera_z_m));
  counts_.assign(std::size_t(stride_) * num_layers_, 0);
  changes_.assign(std::size_t(stride_) * num_layers_, Change{});
}

void FanSums::add(const FanLine& line, const FanRay& ray) {
  const Ramps ramps(ray);
  float low = bounds_m_[0] * ray.run_per_rise;  // rho where the ray passes the lower bound of the layer
  for (int layer = 0; layer < num_layers_; ++layer) {
    const float high = bounds_m_[layer + 1] * ray.run_per_rise;
    const float from = std::max(0.0F, std::min(low, high)), to = std::min(ray.end_m, std::max(low, high));
    if (from < to) add_stretch(line, ramps, layer, from, to);
    low = high;
  }
}

void FanSums::add_stretch(const FanLine& line, const Ramps& ramps, int layer, float from_m, float to_m) {
  const int first = line.column_at(from_m), last = line.column_at(to_m);
  const std::size_t row = std::size_t(layer) * stride_;
  ++counts_[row + first];
  --counts_[row + last + 1];
  if (to_m > ramps.begin_m) add_hit(line, ramps, changes_.data() + row, first, last, from_m, to_m);
}

void FanSums::add_hit(const FanLine& line, const Ramps& ramps, Change* changes, int first, int last,
                      float from_m, float to_m) const {
  const auto add_one_column = [&](int j, float rho_m) {
    const Change value = ramps.at(rho_m);
    changes[j].met += value.met, changes[j].passed += value.passed;
    changes[j + 1].met -= value.met, changes[j + 1].passed -= value.passed;
  };
  // In the first and last column the ray may not come as near to the axis as the line does.
  int begin = first, end = last + 1;
  if (line.nearest_m(first) < from_m) add_one_column(begin++, from_m);
  if (begin < end && line.nearest_m(last) > to_m) add_one_column(--end, to_m);
  if (begin >= end) return;
  const auto column_of = [&](float rho_m) {
    const int column = line.column_at(std::clamp(rho_m, from_m, to_m));
    return std::clamp(first_not_before(line, column, rho_m), begin, end);
  };
  Change& met_begins = changes[column_of(ramps.begin_m)];
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

void FanSums::flush(const FanLine& line, ViewEvidence& evidence) {
  constexpr double kUnit = static_cast<double>(kEvidenceOne) / static_cast<double>(kOne);
  std::vector<std::int32_t> rays(num_layers_, 0);
  std::vector<Change> sum(num_layers_);
  for (int j = 0; j < line.size(); ++j) {
    EvidenceSum* cells = nullptr;
    for (int layer = 0; layer < num_layers_; ++layer) {
      const std::size_t place = std::size_t(layer) * stride_ + j;
      const Change& change = changes_[place];
      Change& s = sum[layer];
      s.met += change.met, s.met_slope += change.met_slope;
      s.passed += change.passed, s.passed_slope += change.passed_slope;
      const std::int64_t n = rays[layer] += counts_[place];
      if (n == 0) continue;
      const double rho = line.nearest_m(j);
      const double all = static_cast<double>(n) * kEvidenceOne;
      const double met = std::clamp((double(s.met) + double(s.met_slope) * rho) * kUnit, 0.0, all);
      const double passed = std::clamp((double(s.passed) + double(s.passed_slope) * rho) * kUnit, 0.0, met);
      const auto met_sum = static_cast<std::int64_t>(met + 0.5),
                 passed_sum = static_cast<std::int64_t>(passed + 0.5);
      if (cells == nullptr) cells = evidence.column(line.cell(j));
      cells[layer].add(n, n * std::int64_t{kEvidenceOne} - met_sum, met_sum - passed_sum);
    }
  }
}

}  // namespace flogmap
