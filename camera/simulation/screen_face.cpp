#include "camera/simulation/screen_face.hpp"

#include <algorithm>
#include <cmath>

namespace flogmap {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearM = 0.02;
constexpr double kEdgeSlackPx = 1e-3;  // neighbours overlap by this: no pixel falls between them

/// The part of a convex polygon in front of the plane Z = kNearM (Sutherland and Hodgman's clipping).
std::vector<Vector3d> in_front(const std::vector<Vector3d>& corners) {
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d& a = corners[i];
    const Vector3d& b = corners[(i + 1) % corners.size()];
    if (a.z() >= kNearM) kept.push_back(a);
    if ((a.z() >= kNearM) != (b.z() >= kNearM))
      kept.push_back(a + (b - a) * ((kNearM - a.z()) / (b.z() - a.z())));
  }
  return kept;
}

/// direction . ray of the pixel, where the ray has Z = 1.
Affine along_ray(const Vector3d& direction, const StereoCamera& camera) {
  const double f = camera.focal_px;
  return {direction.z() - (direction.x() * camera.cx_px + direction.y() * camera.cy_px) / f,
          direction.x() / f, direction.y() / f};
}

Affine scaled(const Affine& a, double s) { return {a.at_origin * s, a.per_x * s, a.per_y * s}; }

std::vector<Affine> edges_of(const std::vector<Vector2d>& corners) {
  std::vector<Affine> edges;
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& corner : corners) middle += corner / static_cast<double>(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& a = corners[i];
    const Vector2d along = corners[(i + 1) % corners.size()] - a;
    if (along.norm() < 1e-9) continue;
    const Vector2d normal = Vector2d(-along.y(), along.x()) / along.norm();
    Affine edge{-normal.dot(a), normal.x(), normal.y()};
    if (edge(middle.x(), middle.y()) < 0) edge = scaled(edge, -1);
    edges.push_back(edge);
  }
  return edges;
}

/// Rows the polygon can touch; false if it lies outside the picture.
bool find_rows(ScreenFace& screen, const StereoCamera& camera) {
  Vector2d low(1e18, 1e18), high(-1e18, -1e18);
  for (const Vector2d& corner : screen.corners_px) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  if (high.x() < 0 || high.y() < 0 || low.x() > camera.width_px - 1 || low.y() > camera.height_px - 1)
    return false;
  screen.first_row = static_cast<int>(std::ceil(std::max(low.y() - kEdgeSlackPx, 0.0)));
  screen.last_row = static_cast<int>(std::floor(std::min(high.y() + kEdgeSlackPx, camera.height_px - 1.0)));
  return true;
}

}  // namespace

ScreenFace::Span ScreenFace::span(int row, int width_px) const {
  double first = 1e18, last = -1e18;
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const Vector2d& a = corners_px[i];
    const Vector2d& b = corners_px[(i + 1) % corners_px.size()];
    const double low = std::min(a.y(), b.y()), high = std::max(a.y(), b.y());
    if (row < low - kEdgeSlackPx || row > high + kEdgeSlackPx) continue;
    const double share = high - low < 1e-9 ? 0.0 : std::clamp((row - a.y()) / (b.y() - a.y()), 0.0, 1.0);
    const double x = a.x() + share * (b.x() - a.x());
    first = std::min({first, x, high - low < 1e-9 ? b.x() : x});
    last = std::max({last, x, high - low < 1e-9 ? b.x() : x});
  }
  const double from = std::clamp(std::ceil(first - kEdgeSlackPx), 0.0, static_cast<double>(width_px));
  const double to = std::clamp(std::floor(last + kEdgeSlackPx) + 1, 0.0, static_cast<double>(width_px));
  return {static_cast<int>(from), static_cast<int>(to)};
}

bool ScreenFace::contains(double x, double y) const {
  return std::all_of(edges_px.begin(), edges_px.end(),
                     [&](const Affine& edge) { return edge(x, y) >= -kEdgeSlackPx; });
}

std::optional<ScreenFace> project(const Face& face, std::size_t index, double texel_m,
                                  const Eigen::Isometry3d& camera_from_face, const StereoCamera& camera) {
  const Vector3d normal = camera_from_face.linear() * face.normal;
  const double distance = normal.dot(camera_from_face * face.corners_m[0]);
  if (distance >= -1e-9) return std::nullopt;  // seen from behind or edge-on
  std::vector<Vector3d> corners;
  for (const Vector3d& corner : face.corners_m) corners.push_back(camera_from_face * corner);
  corners = in_front(corners);
  if (corners.size() < 3) return std::nullopt;

  ScreenFace screen;
  screen.face = index;
  for (const Vector3d& c : corners) {
    screen.corners_px.emplace_back(camera.focal_px * c.x() / c.z() + camera.cx_px,
                                   camera.focal_px * c.y() / c.z() + camera.cy_px);
  }
  if (!find_rows(screen, camera)) return std::nullopt;
  const Vector3d u_axis = camera_from_face.linear() * face.u_axis,
                 v_axis = camera_from_face.linear() * face.v_axis;
  const Vector3d origin = camera_from_face * face.origin_m;
  // normal . (Z ray) = distance, so 1/Z = normal . ray / distance; likewise for the texture's axes.
  screen.inverse_depth = scaled(along_ray(normal, camera), 1 / distance);
  screen.u_over_depth = scaled(along_ray(u_axis, camera), 1 / texel_m);
  screen.v_over_depth = scaled(along_ray(v_axis, camera), 1 / texel_m);
  screen.u_origin = u_axis.dot(origin) / texel_m;
  screen.v_origin = v_axis.dot(origin) / texel_m;
  screen.edges_px = edges_of(screen.corners_px);
  return screen;
}

}  // namespace flogmap
