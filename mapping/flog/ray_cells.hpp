// The cells along a ray, exactly: the reference for everything faster.
// After J. Amanatides and A. Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "mapping/flog/grid_spec.hpp"

namespace flogmap {

/// A straight way through the world; metres.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  // unit length
  double length_m = 0;
};

/// The part of a ray inside one cell, as distances from the ray's origin; metres.
struct Chord {
  CellIndex column;
  int layer = 0;
  double begin_m = 0;
  double end_m = 0;      // > begin_m
  double nearest_m = 0;  // of the chord's point nearest to the cell's vertical axis
};

namespace detail {

/// Distances along the ray between which it is inside the slab of all layers; begin >= end if it never is.
inline std::array<double, 2> clip_to_layers(const GridSpec& grid, const Ray& ray) {
  const double low = grid.layer_bounds_m.front() - ray.origin.z();
  const double high = grid.layer_bounds_m.back() - ray.origin.z();
  const double dz = ray.direction.z();
  if (dz == 0) return {0, low <= 0 && 0 < high ? ray.length_m : 0};
  return {std::max(0.0, std::min(low / dz, high / dz)),
          std::min(ray.length_m, std::max(low / dz, high / dz))};
}

/// One horizontal axis of the walk: which column, and where the ray leaves it.
struct ColumnAxis {
  double origin, inverse, a;
  std::int32_t cell, step;

  ColumnAxis(double origin_m, double direction, double begin_m, double cell_size_m)
      : origin(origin_m),
        inverse(1 / direction),
        a(cell_size_m),
        cell(static_cast<std::int32_t>(std::floor((origin_m + direction * begin_m) / cell_size_m))),
        step(direction < 0 ? -1 : 1) {}

  [[nodiscard]] double exit_m() const {
    if (!std::isfinite(inverse)) return std::numeric_limits<double>::infinity();
    return ((cell + (step > 0 ? 1 : 0)) * a - origin) * inverse;
  }
};

/// The vertical axis: layers of any height.
struct LayerAxis {
  const GridSpec& grid;
  double origin, inverse;
  int layer, step;

  LayerAxis(const GridSpec& spec, double origin_m, double direction, double begin_m)
      : grid(spec), origin(origin_m), inverse(1 / direction), layer(0), step(direction < 0 ? -1 : 1) {
    const double z = origin_m + direction * begin_m;
    const auto& bounds = grid.layer_bounds_m;
    const auto above = std::upper_bound(bounds.begin(), bounds.end(), z) - bounds.begin();
    layer = std::clamp(static_cast<int>(above) - 1, 0, grid.num_layers() - 1);
  }

  [[nodiscard]] double exit_m() const {
    if (!std::isfinite(inverse)) return std::numeric_limits<double>::infinity();
    return (grid.layer_bounds_m[layer + (step > 0 ? 1 : 0)] - origin) * inverse;
  }
  [[nodiscard]] bool inside() const { return layer >= 0 && layer < grid.num_layers(); }
};

}  // namespace detail

/// Calls visit(const Chord&) for every cell that the ray crosses, in order; each cell once. The chords join
/// without a gap and fill the part of the ray inside the layers.
template <typename Visit>
void for_each_cell(const GridSpec& grid, const Ray& ray, Visit&& visit) {
  const auto [begin, end] = detail::clip_to_layers(grid, ray);
  if (!(begin < end)) return;
  const double dx = ray.direction.x(), dy = ray.direction.y();
  detail::ColumnAxis x(ray.origin.x(), dx, begin, grid.cell_size_m);
  detail::ColumnAxis y(ray.origin.y(), dy, begin, grid.cell_size_m);
  detail::LayerAxis z(grid, ray.origin.z(), ray.direction.z(), begin);
  double x_exit = x.exit_m(), y_exit = y.exit_m(), z_exit = z.exit_m();
  const double flat = dx * dx + dy * dy;
  const double per_flat = flat > 0 ? 1 / flat : 0;
  for (double r = begin; z.inside();) {
    const double next = std::min({x_exit, y_exit, z_exit, end});
    if (next > r) {
      const double to_axis = (cell_middle_m(grid, x.cell) - ray.origin.x()) * dx +
                             (cell_middle_m(grid, y.cell) - ray.origin.y()) * dy;
      visit(Chord{{x.cell, y.cell}, z.layer, r, next, std::clamp(to_axis * per_flat, r, next)});
      r = next;
    }
    if (next >= end) return;
    if (x_exit <= next) {
      x.cell += x.step;
      x_exit = x.exit_m();
    } else if (y_exit <= next) {
      y.cell += y.step;
      y_exit = y.exit_m();
    } else {
      z.layer += z.step;
      z_exit = z.exit_m();
    }
  }
}

}  // namespace flogmap
