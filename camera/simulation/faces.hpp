#pragma once

#include <Eigen/Core>
#include <vector>

#include "camera/simulation/scene.hpp"

namespace flogmap {

/// A convex flat polygon of a solid, seen from the side its normal points to, with a frame for its texture:
/// a point's texture coordinates are (u_axis . (p - origin), v_axis . (p - origin)), metres, from 0 to
/// extent.
struct Face {
  std::vector<Eigen::Vector3d> corners_m;  // world, anticlockwise seen from outside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d u_axis = Eigen::Vector3d::UnitX();
  Eigen::Vector3d v_axis = Eigen::Vector3d::UnitY();
  Eigen::Vector2d extent_m = Eigen::Vector2d::Ones();
  double u_offset_m = 0;  // where the pattern begins: carries it on around a cylinder
  std::size_t pattern_seed = 0;
  std::size_t solid = 0;  // index into Scene::solids
  std::size_t material = 0;
};

/// All faces of all solids, where the scene puts them (before any motion).
[[nodiscard]] std::vector<Face> faces_of(const Scene& scene);

}  // namespace flogmap
