// From a pixel and its disparity to a point, and how uncertain it is. FLOG.md section 1, eqs. (1)-(5).
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "camera/stereo_camera.hpp"

namespace flogmap {

/// Standard deviation of one image point along one axis, pixels (De of the paper).
inline constexpr double kImageSigmaPx = 0.1;

/// The point seen at pixel (x, y) of the left image with disparity d > 0 px; metres, camera frame. Eq. (1).
inline Eigen::Vector3d triangulate(const StereoCamera& camera, double x_px, double y_px, double d) {
  const double t = camera.baseline_m;
  return {(x_px - camera.cx_px) * t / d, (y_px - camera.cy_px) * t / d, camera.focal_px * t / d};
}

/// Standard deviations of X, Y and Z of a triangulated point, metres. Eqs. (2)-(4).
inline Eigen::Vector3d point_sigma(const StereoCamera& camera, const Eigen::Vector3d& p,
                                   double De = kImageSigmaPx) {
  const double f = camera.focal_px, t = camera.baseline_m;
  const double X = p.x(), Y = p.y(), Z = p.z();
  const double k = De * Z / (f * t);
  return {k * std::sqrt((t - X) * (t - X) + X * X), k * std::sqrt(2 * Y * Y + t * t / 2),
          k * Z * std::sqrt(2.0)};
}

/// Covariance of a triangulated point, metres^2: the same errors with their correlations, from
/// independent errors De of x_l and x_r and De/sqrt(2) of the mean row y.
inline Eigen::Matrix3d point_covariance(const StereoCamera& camera, const Eigen::Vector3d& p,
                                        double De = kImageSigmaPx) {
  const double f = camera.focal_px, t = camera.baseline_m;
  const double X = p.x(), Y = p.y(), Z = p.z();
  const double s = Z / (f * t);  // 1/d
  // Columns: derivatives by x_l, x_r, y of (1), with d = x_l - x_r.
  Eigen::Matrix3d J;
  J << s * (t - X), s * X, 0, -s * Y, s * Y, s * t, -s * Z, s * Z, 0;
  return J * Eigen::Vector3d(De * De, De * De, De * De / 2).asDiagonal() * J.transpose();
}

}  // namespace flogmap
