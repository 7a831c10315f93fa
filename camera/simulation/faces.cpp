#include "camera/simulation/faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flogmap {
namespace {

using Eigen::Vector3d;

/// Normal and texture frame from the corners; v points as far up as the face allows.
Face make_face(std::vector<Vector3d> corners) {
  Face face;
  const Vector3d a = corners[1] - corners[0], b = corners[2] - corners[0];
  face.normal = a.cross(b).normalized();
  const bool level = std::abs(face.normal.z()) > 0.9;
  const Vector3d up = level ? Vector3d(Vector3d::UnitY()) : Vector3d(Vector3d::UnitZ());
  face.v_axis = (up - face.normal * face.normal.dot(up)).normalized();
  face.u_axis = face.v_axis.cross(face.normal);
  Eigen::Vector2d low(1e18, 1e18), high(-1e18, -1e18);
  for (const Vector3d& corner : corners) {
    const Eigen::Vector2d uv(face.u_axis.dot(corner), face.v_axis.dot(corner));
    low = low.cwiseMin(uv);
    high = high.cwiseMax(uv);
  }
  face.origin_m = corners[0] + face.u_axis * (low.x() - face.u_axis.dot(corners[0])) +
                  face.v_axis * (low.y() - face.v_axis.dot(corners[0]));
  face.extent_m = high - low;
  face.corners_m = std::move(corners);
  return face;
}

/// The six faces of a box around the solid's origin, in the solid's frame; sides first, then top and bottom.
std::vector<Face> box_faces(const Solid& solid) {
  const Vector3d h = solid.size_m / 2;
  const auto corner = [&](int x, int y, int z) { return Vector3d(x * h.x(), y * h.y(), z * h.z()); };
  const std::array<std::array<Vector3d, 4>, 6> quads{{
      {corner(1, -1, -1), corner(1, 1, -1), corner(1, 1, 1), corner(1, -1, 1)},
      {corner(-1, 1, -1), corner(-1, -1, -1), corner(-1, -1, 1), corner(-1, 1, 1)},
      {corner(1, 1, -1), corner(-1, 1, -1), corner(-1, 1, 1), corner(1, 1, 1)},
      {corner(-1, -1, -1), corner(1, -1, -1), corner(1, -1, 1), corner(-1, -1, 1)},
      {corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1)},
      {corner(-1, 1, -1), corner(1, 1, -1), corner(1, -1, -1), corner(-1, -1, -1)},
  }};
  std::vector<Face> faces;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    std::vector<Vector3d> corners(quads[i].begin(), quads[i].end());
    if (solid.kind == SolidKind::hall) std::reverse(corners.begin(), corners.end());
    faces.push_back(make_face(std::move(corners)));
    faces.back().material = i < 4 ? solid.side : i == 4 ? solid.top : solid.bottom;
    faces.back().pattern_seed = i;
  }
  return faces;
}

std::vector<Face> cylinder_faces(const Solid& solid) {
  const double radius = solid.size_m.x() / 2, half = solid.size_m.z() / 2;
  const auto rim = [&](int i, double z) {
    const double angle = 2 * std::numbers::pi * i / solid.facets;
    return Vector3d(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  std::vector<Face> faces;
  std::vector<Vector3d> top, bottom;
  for (int i = 0; i < solid.facets; ++i) {
    faces.push_back(make_face({rim(i, -half), rim(i + 1, -half), rim(i + 1, half), rim(i, half)}));
    faces.back().material = solid.side;
    faces.back().u_offset_m = i * faces.back().extent_m.x();
    top.push_back(rim(i, half));
    bottom.insert(bottom.begin(), rim(i, -half));
  }
  for (auto& [rim_corners, material] : {std::pair(&top, solid.top), std::pair(&bottom, solid.bottom)}) {
    faces.push_back(make_face(std::move(*rim_corners)));
    faces.back().material = material;
    faces.back().pattern_seed = 1;
  }
  return faces;
}

std::vector<Face> mesh_faces(const Solid& solid) {
  std::vector<Face> faces;
  for (const Eigen::Vector3i& t : solid.triangles) {
    const Vector3d a = solid.vertices_m[t[0]], b = solid.vertices_m[t[1]], c = solid.vertices_m[t[2]];
    if ((b - a).cross(c - a).norm() < 1e-12) continue;  // no area
    faces.push_back(make_face({a, b, c}));
    faces.back().material = solid.side;
    faces.back().pattern_seed = faces.size();
  }
  return faces;
}

void move(Face& face, const Eigen::Isometry3d& world_from_solid) {
  for (Vector3d& corner : face.corners_m) corner = world_from_solid * corner;
  face.origin_m = world_from_solid * face.origin_m;
  for (Vector3d* axis : {&face.normal, &face.u_axis, &face.v_axis}) *axis = world_from_solid.linear() * *axis;
}

std::vector<Face> faces_of_solid(const Solid& solid) {
  switch (solid.kind) {
    case SolidKind::cylinder:
      return cylinder_faces(solid);
    case SolidKind::mesh:
      return mesh_faces(solid);
    case SolidKind::box:
    case SolidKind::hall:
      break;
  }
  return box_faces(solid);
}

}  // namespace

std::vector<Face> faces_of(const Scene& scene) {
  std::vector<Face> faces;
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    for (Face& face : faces_of_solid(scene.solids[i])) {
      move(face, scene.solids[i].world_from_solid);
      face.solid = i;
      face.pattern_seed += 64 * i;
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

}  // namespace flogmap
