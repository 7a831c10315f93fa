// The columns below one line of sight, seen from above. FLOG.md section 7, point 2.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping/flog/grid_spec.hpp"

namespace flogmap {

/// Columns j = 0, 1, 2 ... along a line that starts at the camera. rho is the horizontal distance from it,
/// metres.
class FanLine {
 public:
  /// Walks from `start_m` (world) along the unit vector `direction` at least as far as rho = end_m.
  void walk(const GridSpec& grid, const Eigen::Vector2d& start_m, const Eigen::Vector2d& direction,
            float end_m);

  /// The column at rho: the crossings of column edges before it, counted along x and y. 0 <= rho <= end_m.
  [[nodiscard]] int column_at(float rho_m) const {
    return static_cast<int>(x_.per_m * rho_m + x_.before) + static_cast<int>(y_.per_m * rho_m + y_.before);
  }

  [[nodiscard]] int size() const { return static_cast<int>(cells_.size()); }
  [[nodiscard]] CellIndex cell(int j) const { return cells_[j]; }
  [[nodiscard]] const CellIndex* cells() const { return cells_.data(); }

  /// rho of the point of the line within column j that is nearest to the column's axis; never falls with j.
  [[nodiscard]] float nearest_m(int j) const { return nearest_m_[j]; }

 private:
  struct Axis {
    float per_m = 0;   // edges crossed per metre of rho
    float before = 0;  // part of a cell already behind the start, [0, 1)
  };
  static Axis axis(double start_cells, double per_m);
  [[nodiscard]] static float next_edge_m(const Axis& axis, int crossed) {
    return axis.per_m > 0 ? (static_cast<float>(crossed + 1) - axis.before) / axis.per_m : 1e30F;
  }

  Axis x_, y_;
  std::vector<CellIndex> cells_;
  std::vector<float> nearest_m_;
};

inline FanLine::Axis FanLine::axis(double start_cells, double per_m) {
  const double part = start_cells - std::floor(start_cells);
  // Just below 1, so that rho = 0 is in the first cell even where the start lies on an edge.
  const double before = per_m < 0 ? std::min(1 - part, 1 - 1e-6) : part;
  return {static_cast<float>(std::abs(per_m)), static_cast<float>(before)};
}

inline void FanLine::walk(const GridSpec& grid, const Eigen::Vector2d& start_m,
                          const Eigen::Vector2d& direction, float end_m) {
  const double a = grid.cell_size_m;
  x_ = axis(start_m.x() / a, direction.x() / a);
  y_ = axis(start_m.y() / a, direction.y() / a);
  const int last = column_at(end_m);
  cells_.clear();
  nearest_m_.clear();
  const CellIndex first = cell_at(grid, start_m.x(), start_m.y());
  const auto ux = static_cast<float>(direction.x()), uy = static_cast<float>(direction.y());
  const int step_x = ux < 0 ? -1 : 1, step_y = uy < 0 ? -1 : 1;
  const auto to_axis_x = static_cast<float>(cell_middle_m(grid, first.x) - start_m.x());
  const auto to_axis_y = static_cast<float>(cell_middle_m(grid, first.y) - start_m.y());
  float to_axis = to_axis_x * ux + to_axis_y * uy;  // rho of the point of the whole line nearest to the axis
  const float along_x = static_cast<float>(a) * std::abs(ux), along_y = static_cast<float>(a) * std::abs(uy);
  float entered = 0;
  int nx = 0, ny = 0;
  float edge_x = next_edge_m(x_, 0), edge_y = next_edge_m(y_, 0);
  for (int j = 0; j <= last; ++j) {
    const float left = std::min(edge_x, edge_y);
    cells_.push_back({first.x + step_x * nx, first.y + step_y * ny});
    const float middle = to_axis + static_cast<float>(nx) * along_x + static_cast<float>(ny) * along_y;
    nearest_m_.push_back(std::clamp(middle, entered, std::max(entered, left)));
    entered = std::max(entered, left);
    if (edge_x <= edge_y) {
      edge_x = next_edge_m(x_, ++nx);
    } else {
      edge_y = next_edge_m(y_, ++ny);
    }
  }
}

}  // namespace flogmap
