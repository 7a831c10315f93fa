#include "mapping/odometry/slant.hpp"

#include <Eigen/LU>
#include <cmath>

namespace flogmap {
namespace {

constexpr int kRadius_px = 7;
constexpr double kSameSurface_px = 2.5;  // from the corner's disparity
constexpr double kFlat_px = 0.4;         // root mean square distance from the plane
constexpr double kSteepest = 0.6;        // px per px; more is an edge rather than a surface
constexpr double kLeastShare = 0.6;      // of the window that must belong to the surface
constexpr double kFacing = 0.01;         // px per px; less is noise of the disparities

}  // namespace

Slant slant_at(const DisparityImage& disparity, const Eigen::Vector2f& px, float disparity_px) {
  const int cx = static_cast<int>(px.x() + 0.5F), cy = static_cast<int>(px.y() + 0.5F);
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double squares = 0;
  int count = 0;
  for (int v = -kRadius_px; v <= kRadius_px; ++v) {
    for (int u = -kRadius_px; u <= kRadius_px; ++u) {
      if (!disparity.px.contains(cx + u, cy + v)) continue;
      const double d = disparity.px.at(cx + u, cy + v) - disparity_px;
      if (!(std::abs(d) <= kSameSurface_px)) continue;
      const Eigen::Vector3d row(u, v, 1);
      A += row * row.transpose();
      b += d * row;
      squares += d * d;
      ++count;
    }
  }
  constexpr int kSide = 2 * kRadius_px + 1;
  if (count < kLeastShare * kSide * kSide) return Slant::Zero();
  const Eigen::Vector3d plane = A.inverse() * b;
  if (squares - plane.dot(b) > kFlat_px * kFlat_px * count) return Slant::Zero();
  const Slant slant = plane.head<2>();
  return slant.norm() > kFacing && slant.norm() < kSteepest ? slant : Slant::Zero();
}

Eigen::Matrix2d left_from_right(const Slant& slant) {
  Eigen::Matrix2d turned;
  turned << 1, slant.y(), 0, 1 - slant.x();
  return turned / (1 - slant.x());
}

}  // namespace flogmap
