#include "mapping/odometry/surface_patches.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "mapping/triangulate.hpp"

namespace flogmap {
namespace {

constexpr int kStepPx = 2;
constexpr double kLeastShare = 0.8;  // of the samples that must be valid
constexpr double kGrazing = 8;       // a surface seen flatter than this counts no larger
constexpr double kFlat_px = 0.3;     // root mean square distance of the samples from the plane

/// d = a x + b y + c, x and y from the block's middle.
struct DisparityPlane {
  Eigen::Vector3d abc;
  double rms_px = 0;
};

/// About twenty blocks side by side, whatever the picture's size.
int block_side(int width_px) { return std::clamp(width_px / 20 / kStepPx * kStepPx, 12, 32); }

std::optional<DisparityPlane> fit(const Image<float>& px, int left, int top, int side) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double squares = 0;
  int count = 0;
  const double middle = 0.5 * (side - 1);
  for (int v = 0; v < side; v += kStepPx) {
    for (int u = 0; u < side; u += kStepPx) {
      const double d = px.at(left + u, top + v);
      if (!(d > 0)) continue;
      const Eigen::Vector3d row(u - middle, v - middle, 1);
      A += row * row.transpose();
      b += d * row;
      squares += d * d;
      ++count;
    }
  }
  if (count < kLeastShare * side * side / (kStepPx * kStepPx)) return std::nullopt;
  const Eigen::Vector3d abc = A.inverse() * b;
  const double rms = std::sqrt(std::max(squares - abc.dot(b), 0.0) / count);
  if (rms > kFlat_px) return std::nullopt;
  return DisparityPlane{abc, rms};
}

}  // namespace

std::vector<SurfacePatch> surface_patches(const StereoCamera& camera, const DisparityImage& disparity) {
  std::vector<SurfacePatch> patches;
  const Image<float>& px = disparity.px;
  const int side = block_side(px.width);
  for (int top = 0; top + side <= px.height; top += side) {
    for (int left = 0; left + side <= px.width; left += side) {
      const auto plane = fit(px, left, top, side);
      if (!plane) continue;
      const double x = left + 0.5 * (side - 1), y = top + 0.5 * (side - 1);
      const double a = plane->abc(0), b = plane->abc(1), d = plane->abc(2);
      const double at_centre = d - a * (x - camera.cx_px) - b * (y - camera.cy_px);
      const Eigen::Vector3d minus_n_t_h(a, b, at_centre / camera.focal_px);
      const double h = camera.baseline_m / minus_n_t_h.norm();
      const Eigen::Vector3d centre = triangulate(camera, x, y, d);
      const double Z_per_px = side * centre.z() / camera.focal_px;
      const double area = Z_per_px * Z_per_px * std::min(centre.z() / h, kGrazing);
      patches.push_back(
          {centre, -minus_n_t_h.normalized(), h * std::max(plane->rms_px, kImageSigmaPx) / d, area});
    }
  }
  return patches;
}

}  // namespace flogmap
