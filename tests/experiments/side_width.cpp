#include "tests/experiments/side_width.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_value.hpp"

namespace flogmap::experiments {
namespace {

using Eigen::Vector2d;

constexpr double kAcross_m = 0.09, kStep_m = 0.0005;

/// Something of the cells, linear between their middles.
template <typename OfCell>
double between_cells(const MapSnapshot& map, int layer, const Vector2d& p, const OfCell& of_cell) {
  const double a = map.info.grid.cell_size_m;
  const double x = p.x() / a - 0.5, y = p.y() / a - 0.5;
  const auto x0 = static_cast<std::int32_t>(std::floor(x)), y0 = static_cast<std::int32_t>(std::floor(y));
  const double u = x - x0, v = y - y0;
  const auto at = [&](int dx, int dy) { return double{of_cell(cell_in(map, {x0 + dx, y0 + dy}, layer))}; };
  return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
}

double full_value(const Cell& cell) {
  return cell.rays == 0 ? 0 : map_value(Operators::algebraic, mu_E(cell), mu_O(cell), 1);
}

/// From where the values first pass half their peak, going outwards from it, on both sides.
double half_width_steps(const std::vector<double>& values, std::size_t peak) {
  const double half = values[peak] / 2;
  std::size_t low = peak, high = peak;
  while (low > 0 && values[low] > half) --low;
  while (high + 1 < values.size() && values[high] > half) ++high;
  return static_cast<double>(high - low);
}

}  // namespace

SideProfile profile_of(const MapSnapshot& map, int layer, const Side& side) {
  const Vector2d along = side.to_m - side.from_m;
  const Vector2d outwards = Vector2d(-along.y(), along.x()).normalized();
  const float N_K = map.info.full_confidence_rays[layer];
  const auto K_of = [&](const Cell& cell) { return confidence(cell, N_K); };
  constexpr int kFeet = 21;
  std::vector<double> values, confidences;
  for (double s = -kAcross_m; s <= kAcross_m; s += kStep_m) {
    double value = 0, K = 0;
    for (int foot = 0; foot < kFeet; ++foot) {
      const Vector2d p = side.from_m + (0.25 + 0.5 * foot / (kFeet - 1)) * along + s * outwards;
      value += between_cells(map, layer, p, full_value) / kFeet;
      K += between_cells(map, layer, p, K_of) / kFeet;
    }
    values.push_back(value), confidences.push_back(K);
  }
  const auto peak = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  return {half_width_steps(values, peak) * kStep_m, values[peak], values[peak] * confidences[peak],
          confidences[peak]};
}

}  // namespace flogmap::experiments
