#include "camera/simulation/occupancy.hpp"

#include <algorithm>
#include <cmath>

#include "camera/simulation/faces.hpp"
#include "camera/simulation/renderer.hpp"

namespace flogmap {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

constexpr double kTouchM = 1e-7;  // surfaces that only touch do not overlap

/// The part of a convex polygon where sign * p[axis] <= sign * bound.
Polygon clipped(const Polygon& polygon, int axis, double bound, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (bound - a[axis]), db = sign * (bound - b[axis]);
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

/// A hall as the six slabs around it; other solids as they are.
std::vector<Solid> massive(const Solid& solid) {
  if (solid.kind != SolidKind::hall) return {solid};
  std::vector<Solid> slabs;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Solid slab = solid;
      slab.kind = SolidKind::box;
      slab.size_m = solid.size_m + 2 * kHallWallM * Vector3d::Ones();
      slab.size_m[axis] = kHallWallM;
      slab.world_from_solid.translate(
          Vector3d(side * (solid.size_m[axis] + kHallWallM) / 2 * Vector3d::Unit(axis)));
      slabs.push_back(slab);
    }
  }
  return slabs;
}

/// Marks the cells of one layer that solids overlap.
class LayerPainter {
 public:
  LayerPainter(const Truth& truth, double z_min_m, double z_max_m)
      : truth_(truth), z_min_(z_min_m + kTouchM), z_max_(z_max_m - kTouchM) {
    const Eigen::Vector2i size = truth_size(truth);
    layer_ = Image<std::uint8_t>(size.x(), size.y(), 0);
  }

  void add(const std::vector<Face>& faces) {
    for (const Face& face : faces) add_surface(face.corners_m);
    add_interior(faces);
  }

  [[nodiscard]] Image<std::uint8_t> take() { return std::move(layer_); }

 private:
  struct Range {
    int first, last;
  };
  [[nodiscard]] Range cells(double low, double high, double origin, int count) const {
    return {std::max(0, static_cast<int>(std::floor((low + kTouchM - origin) / truth_.cell_m))),
            std::min(count - 1, static_cast<int>(std::floor((high - kTouchM - origin) / truth_.cell_m)))};
  }
  static std::pair<double, double> extent(const Polygon& polygon, int axis) {
    double low = 1e18, high = -1e18;
    for (const Vector3d& p : polygon) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
    return {low, high};
  }

  /// A face meets a cell if what is left of it between the layer's heights and the row's sides reaches the
  /// cell.
  void add_surface(const Polygon& corners) {
    const Polygon in_layer = clipped(clipped(corners, 2, z_max_, 1), 2, z_min_, -1);
    if (in_layer.size() < 2) return;
    const auto [y_low, y_high] = extent(in_layer, 1);
    const Range rows = cells(y_low, y_high, truth_.min_m.y(), layer_.height);
    for (int row = rows.first; row <= rows.last; ++row) {
      const double y = truth_.min_m.y() + row * truth_.cell_m;
      const Polygon in_row =
          clipped(clipped(in_layer, 1, y + truth_.cell_m - kTouchM, 1), 1, y + kTouchM, -1);
      if (in_row.empty()) continue;
      const auto [x_low, x_high] = extent(in_row, 0);
      const Range columns = cells(x_low, x_high, truth_.min_m.x(), layer_.width);
      for (int column = columns.first; column <= columns.last; ++column) layer_.at(column, row) = 255;
    }
  }

  /// Cells wholly inside: an upward line from the cell's middle leaves the solid an odd number of times.
  void add_interior(const std::vector<Face>& faces) {
    const double z = (z_min_ + z_max_) / 2;
    Polygon all;
    for (const Face& face : faces) all.insert(all.end(), face.corners_m.begin(), face.corners_m.end());
    const auto [x_low, x_high] = extent(all, 0);
    const auto [y_low, y_high] = extent(all, 1);
    const Range columns = cells(x_low, x_high, truth_.min_m.x(), layer_.width);
    const Range rows = cells(y_low, y_high, truth_.min_m.y(), layer_.height);
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int column = columns.first; column <= columns.last; ++column) {
        // A little off the middle, so that no line runs along an edge.
        const Vector2d middle = truth_.min_m + truth_.cell_m * Vector2d(column + 0.50123, row + 0.50311);
        const auto above = std::count_if(faces.begin(), faces.end(),
                                         [&](const Face& face) { return is_above(face, middle, z); });
        if (above % 2 == 1) layer_.at(column, row) = 255;
      }
    }
  }

  static bool is_above(const Face& face, const Vector2d& p, double z) {
    if (std::abs(face.normal.z()) < 1e-9) return false;
    const Vector3d& origin = face.corners_m[0];
    const double height = origin.z() - face.normal.head<2>().dot(p - origin.head<2>()) / face.normal.z();
    if (height <= z) return false;
    bool inside = false;
    const std::vector<Vector3d>& c = face.corners_m;
    for (std::size_t i = 0, j = c.size() - 1; i < c.size(); j = i++) {
      if ((c[i].y() > p.y()) == (c[j].y() > p.y())) continue;
      if (p.x() < (c[j].x() - c[i].x()) * (p.y() - c[i].y()) / (c[j].y() - c[i].y()) + c[i].x())
        inside = !inside;
    }
    return inside;
  }

  Truth truth_;
  double z_min_, z_max_;
  Image<std::uint8_t> layer_;
};

}  // namespace

Eigen::Vector2i truth_size(const Truth& truth) {
  const Eigen::Array2d cells = (truth.max_m - truth.min_m).array() / truth.cell_m;
  return (cells - 1e-6).ceil().cast<int>().matrix();
}

Image<std::uint8_t> true_occupancy(const Scene& scene, double z_min_m, double z_max_m, double time_s) {
  LayerPainter painter(scene.truth, z_min_m, z_max_m);
  for (const Solid& solid : scene.solids) {
    const auto shift = shift_at(solid, time_s);
    if (!shift) continue;
    for (Solid& part : massive(solid)) {
      part.world_from_solid.pretranslate(*shift);
      Scene alone;
      alone.solids = {part};
      painter.add(faces_of(alone));
    }
  }
  return painter.take();
}

SeenCells::SeenCells(const Truth& truth, double reach_m) : truth_(truth), reach_m_(reach_m) {
  const Eigen::Vector2i size = truth_size(truth);
  layers_.assign(truth.layer_bounds_m.size() - 1, Image<std::uint8_t>(size.x(), size.y(), 0));
  surfaces_ = layers_;
}

void SeenCells::mark(Layers& layers, const Vector3d& point) const {
  const std::vector<double>& bounds = truth_.layer_bounds_m;
  if (point.z() < bounds.front() || point.z() >= bounds.back()) return;
  const auto layer = std::upper_bound(bounds.begin(), bounds.end(), point.z()) - bounds.begin() - 1;
  const Vector2d cell = (point.head<2>() - truth_.min_m) / truth_.cell_m;
  const int x = static_cast<int>(std::floor(cell.x())), y = static_cast<int>(std::floor(cell.y()));
  if (layers[layer].contains(x, y)) layers[layer].at(x, y) = 255;
}

void SeenCells::add(const Image<float>& inverse_depth, const StereoCamera& camera,
                    const Eigen::Isometry3d& world_from_left) {
  constexpr int kEveryPx = 4;
  for (int y = 0; y < inverse_depth.height; y += kEveryPx) {
    for (int x = 0; x < inverse_depth.width; x += kEveryPx) {
      if (inverse_depth.at(x, y) <= 0) continue;
      const Vector3d ray((x - camera.cx_px) / camera.focal_px, (y - camera.cy_px) / camera.focal_px, 1);
      const Vector3d end = ray / inverse_depth.at(x, y);
      const double length = end.norm();
      const Vector3d direction = world_from_left.linear() * end / length;
      const double step = truth_.cell_m * 0.7;
      for (double r = 0; r < std::min(length, reach_m_); r += step)
        mark(layers_, world_from_left.translation() + r * direction);
      if (length >= reach_m_) continue;
      const Vector3d hit = world_from_left.translation() + (length + 1e-3) * direction;
      mark(layers_, hit);
      mark(surfaces_, hit);
    }
  }
}

}  // namespace flogmap
