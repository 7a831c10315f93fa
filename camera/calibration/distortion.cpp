#include "camera/calibration/distortion.hpp"

#include <Eigen/LU>
#include <cmath>

namespace flogmap {
namespace {

constexpr int kMaxSteps = 50;
constexpr double kTolerance = 1e-12;

double coefficient(const CameraIntrinsics& camera, std::size_t index) {
  return index < camera.coefficients.size() ? camera.coefficients[index] : 0.0;
}

/// Radial factor and tangential shift in the order k1 k2 p1 p2 k3 k4 k5 k6, as OpenCV's calib3d documents it.
Eigen::Vector2d distort_polynomial(const CameraIntrinsics& camera, const Eigen::Vector2d& m) {
  const auto k = [&](std::size_t index) { return coefficient(camera, index); };
  const double x = m.x(), y = m.y();
  const double r2 = m.squaredNorm();
  const double numerator = 1 + r2 * (k(0) + r2 * (k(1) + r2 * k(4)));
  const double denominator = 1 + r2 * (k(5) + r2 * (k(6) + r2 * k(7)));
  const double radial = numerator / denominator;
  return {x * radial + 2 * k(2) * x * y + k(3) * (r2 + 2 * x * x),
          y * radial + k(2) * (r2 + 2 * y * y) + 2 * k(3) * x * y};
}

double equidistant_radius(const CameraIntrinsics& camera, double theta) {
  const auto k = [&](std::size_t index) { return coefficient(camera, index); };
  const double t2 = theta * theta;
  return theta * (1 + t2 * (k(0) + t2 * (k(1) + t2 * (k(2) + t2 * k(3)))));
}

std::optional<Eigen::Vector3d> undistort_polynomial(const CameraIntrinsics& camera,
                                                    const Eigen::Vector2d& d) {
  Eigen::Vector2d m = d;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Vector2d residual = distort_polynomial(camera, m) - d;
    if (residual.norm() < kTolerance) return Eigen::Vector3d(m.x(), m.y(), 1.0);
    constexpr double kDelta = 1e-6;
    Eigen::Matrix2d jacobian;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d delta = kDelta * Eigen::Vector2d::Unit(axis);
      jacobian.col(axis) =
          (distort_polynomial(camera, m + delta) - distort_polynomial(camera, m - delta)) / (2 * kDelta);
    }
    if (jacobian.determinant() <= 1e-3) return std::nullopt;  // at or beyond the turning point
    m -= jacobian.inverse() * residual;
  }
  if ((distort_polynomial(camera, m) - d).norm() > 1e-8) return std::nullopt;
  return Eigen::Vector3d(m.x(), m.y(), 1.0);
}

std::optional<Eigen::Vector3d> undistort_equidistant(const CameraIntrinsics& camera,
                                                     const Eigen::Vector2d& d) {
  const double radius = d.norm();
  // The polynomial means something only as far as it rises; beyond its first turning point nothing is seen.
  constexpr double kStep = 0.05, kWidest = 3.1;
  double low = 0, high = kStep;
  while (equidistant_radius(camera, high) < radius) {
    if (high >= kWidest || equidistant_radius(camera, high) <= equidistant_radius(camera, low))
      return std::nullopt;
    low = high;
    high += kStep;
  }
  for (int step = 0; step < kMaxSteps; ++step) {
    const double middle = (low + high) / 2;
    (equidistant_radius(camera, middle) < radius ? low : high) = middle;
  }
  if (radius < kTolerance) return Eigen::Vector3d(d.x(), d.y(), 1.0);
  const Eigen::Vector2d direction = d / radius * std::sin(low);
  return Eigen::Vector3d(direction.x(), direction.y(), std::cos(low));
}

}  // namespace

Eigen::Vector2d pixel_from_ray(const CameraIntrinsics& camera, const Eigen::Vector3d& ray) {
  Eigen::Vector2d m = ray.head<2>() / ray.z();
  if (camera.distortion == Distortion::equidistant) {
    const double r = m.norm();
    if (r > kTolerance) m *= equidistant_radius(camera, std::atan(r)) / r;
  } else if (camera.distortion != Distortion::none) {
    m = distort_polynomial(camera, m);
  }
  return {camera.fx_px * m.x() + camera.cx_px, camera.fy_px * m.y() + camera.cy_px};
}

std::optional<Eigen::Vector3d> ray_from_pixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d d((pixel.x() - camera.cx_px) / camera.fx_px,
                          (pixel.y() - camera.cy_px) / camera.fy_px);
  switch (camera.distortion) {
    case Distortion::none:
      return Eigen::Vector3d(d.x(), d.y(), 1.0);
    case Distortion::equidistant:
      return undistort_equidistant(camera, d);
    case Distortion::radtan:
    case Distortion::rational:
      break;
  }
  return undistort_polynomial(camera, d);
}

bool coefficient_count_fits(Distortion distortion, std::size_t count) {
  switch (distortion) {
    case Distortion::none:
      return count == 0;
    case Distortion::radtan:
      return count == 4 || count == 5;
    case Distortion::rational:
      return count == 8;
    case Distortion::equidistant:
      return count == 4;
  }
  return false;
}

const char* name_of(Distortion distortion) {
  switch (distortion) {
    case Distortion::none:
      return "none";
    case Distortion::radtan:
      return "radtan";
    case Distortion::rational:
      return "rational";
    case Distortion::equidistant:
      return "equidistant";
  }
  return "none";
}

}  // namespace flogmap
