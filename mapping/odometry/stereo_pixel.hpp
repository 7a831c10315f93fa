// Where a point of space appears in a rectified pair.
#pragma once

#include <Eigen/Core>

#include "camera/stereo_camera.hpp"
#include "mapping/triangulate.hpp"

namespace flogmap {

/// (x, y, d): left pixel and disparity. x and d are measured apart (d by aligning left and right patch), so
/// their errors are independent.
using StereoPixel = Eigen::Vector3d;

/// The point seen at a stereo pixel, d > 0. Eq. (1).
inline Eigen::Vector3d triangulate(const StereoCamera& camera, const StereoPixel& s) {
  return triangulate(camera, s.x(), s.y(), s.z());
}

/// The stereo pixel of a point before the camera, Z > 0: the inverse of eq. (1).
inline StereoPixel project(const StereoCamera& camera, const Eigen::Vector3d& p) {
  const double s = camera.focal_px / p.z();
  return {camera.cx_px + s * p.x(), camera.cy_px + s * p.y(), s * camera.baseline_m};
}

/// Derivative of project() by the point.
inline Eigen::Matrix3d project_jacobian(const StereoCamera& camera, const Eigen::Vector3d& p) {
  const double s = camera.focal_px / p.z();
  Eigen::Matrix3d J;
  J << s, 0, -s * p.x() / p.z(), 0, s, -s * p.y() / p.z(), 0, 0, -s * camera.baseline_m / p.z();
  return J;
}

/// Derivative of triangulate() by the stereo pixel.
inline Eigen::Matrix3d triangulate_jacobian(const StereoCamera& camera, const StereoPixel& s) {
  const double t_d = camera.baseline_m / s.z();
  const Eigen::Vector3d p = triangulate(camera, s);
  Eigen::Matrix3d J;
  J << t_d, 0, -p.x() / s.z(), 0, t_d, -p.y() / s.z(), 0, 0, -p.z() / s.z();
  return J;
}

}  // namespace flogmap
