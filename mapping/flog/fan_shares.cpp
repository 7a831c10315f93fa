#include "mapping/flog/fan_shares.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/simd.hpp"

namespace flogmap {
namespace {

/// The wedge over the grid, in cells: its line starts at (x, y) of the first cell and goes along (ux, uy).
struct Wedge {
  CellIndex first;
  float x, y;              // [0, 1)
  float ux, uy;            // unit vector
  float half;              // tangent of half the angle
  float drift_x, drift_y;  // the step across the main axis towards which the line drifts
};

/// Tangent of the angle between the line and a corner seen from the start, positive on the drift's side;
/// `behind` where the corner does not lie ahead.
inline float tangent_to(const Wedge& wedge, float side, float x, float y, float behind) {
  const float ahead = wedge.ux * x + wedge.uy * y, aside = wedge.ux * y - wedge.uy * x;
  return ahead > 1e-3F ? side * aside / ahead : behind;
}

/// 64ths of the wedge between two tangents.
inline float part_of(const Wedge& wedge, float from, float to) {
  const float width = std::min(to, wedge.half) - std::max(from, -wedge.half);
  return std::max(width, 0.0F) / (2 * wedge.half) * static_cast<float>(kWholeShare) + 0.5F;
}

/// The rays that cross a column pass between two of its corners: the one farthest to the drift's side of the
/// line and the opposite one.
FLOGMAP_SIMD_CLONES
void find_shares(const Wedge& wedge, const CellIndex* cells, int count, FanShare* shares) {
  const float side = wedge.ux * wedge.drift_y - wedge.uy * wedge.drift_x > 0 ? 1.0F : -1.0F;
  const float far_x = side * wedge.uy > 0 ? 0.0F : 1.0F, far_y = side * wedge.ux > 0 ? 1.0F : 0.0F;
  const float dx = wedge.drift_x, dy = wedge.drift_y;
  for (int j = 1; j < count; ++j) {
    const float x = static_cast<float>(cells[j].x - wedge.first.x) - wedge.x;
    const float y = static_cast<float>(cells[j].y - wedge.first.y) - wedge.y;
    const float far = tangent_to(wedge, side, x + far_x, y + far_y, 1);
    const float near = tangent_to(wedge, side, x + 1 - far_x, y + 1 - far_y, -1);
    const float drift_near = tangent_to(wedge, side, x + 1 - far_x + dx, y + 1 - far_y + dy, 1);
    const float counter_far = tangent_to(wedge, side, x + far_x - dx, y + far_y - dy, -1);
    shares[j] = {static_cast<std::uint8_t>(part_of(wedge, near, far)),
                 static_cast<std::uint8_t>(part_of(wedge, drift_near, 1)),
                 static_cast<std::uint8_t>(part_of(wedge, -1, counter_far))};
  }
  // A neighbour that the line itself meets has its share already.
  shares[0] = {};
  for (int j = 0; j + 1 < count; ++j) {
    const bool drifts = cells[j + 1].x - cells[j].x == static_cast<int>(dx) &&
                        cells[j + 1].y - cells[j].y == static_cast<int>(dy);
    if (drifts) shares[j].drift = shares[j + 1].counter = 0;
  }
}

}  // namespace

void FanShares::share_out(const GridSpec& grid, const Eigen::Vector2d& start_m, const AzimuthSpread& spread,
                          const FanLine& line) {
  any_ = spread.half_tangent > 0;
  if (!any_) return;
  const Eigen::Vector2d u = spread.direction, start = start_m / grid.cell_size_m;
  const bool along_x = std::abs(u.x()) >= std::abs(u.y());
  drift_ = along_x ? CellIndex{0, u.y() < 0 ? -1 : 1} : CellIndex{u.x() < 0 ? -1 : 1, 0};
  if (shares_.size() < std::size_t(line.size())) shares_.resize(line.size());
  const CellIndex first = line.cell(0);
  const Wedge wedge{first,
                    static_cast<float>(start.x() - first.x),
                    static_cast<float>(start.y() - first.y),
                    static_cast<float>(u.x()),
                    static_cast<float>(u.y()),
                    static_cast<float>(spread.half_tangent),
                    static_cast<float>(drift_.x),
                    static_cast<float>(drift_.y)};
  find_shares(wedge, line.cells(), line.size(), shares_.data());
}

}  // namespace flogmap
