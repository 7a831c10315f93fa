#pragma once

#include <Eigen/Core>
#include <optional>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// A viewing ray (x, y, z > 0) → pixel, with the lens' distortion.
[[nodiscard]] Eigen::Vector2d pixel_from_ray(const CameraIntrinsics& camera, const Eigen::Vector3d& ray);

/// Pixel → viewing ray (not normalised; z may be <= 0 behind a fisheye's horizon). Nothing where the
/// distortion has no inverse, as beyond the turning point of a polynomial.
[[nodiscard]] std::optional<Eigen::Vector3d> ray_from_pixel(const CameraIntrinsics& camera,
                                                            const Eigen::Vector2d& pixel);

/// How many coefficients a model has: {4, 5} for radtan, {8} for rational, {4} for equidistant, {0} for none.
[[nodiscard]] bool coefficient_count_fits(Distortion distortion, std::size_t count);

/// "none", "radtan", "rational" or "equidistant".
[[nodiscard]] const char* name_of(Distortion distortion);

}  // namespace flogmap
