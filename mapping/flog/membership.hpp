// What one ray says about the points along it. FLOG.md sections 1 and 2, eqs. (5)-(7).
#pragma once

#include <algorithm>
#include <numbers>

#include "camera/stereo_camera.hpp"
#include "mapping/triangulate.hpp"

namespace flogmap {

/// How the error of a measured range grows with it, and how wide its memberships are at least.
struct RangeError {
  double per_m2 = 0;         // De sqrt(2) / (f t): range sigma = per_m2 * l * Z, 1/m
  double least_width_m = 0;  // floor of the memberships' width: the cell size, or 0 in paper mode
  bool paper_mode = false;   // literally as in the paper: sigma = per_m2 * l * l, and no floor
};

inline RangeError range_error(const StereoCamera& camera, double cell_size_m, bool paper_mode) {
  const double f = camera.focal_px, t = camera.baseline_m, De = kImageSigmaPx;
  return {De * std::numbers::sqrt2 / (f * t), paper_mode ? 0.0 : cell_size_m, paper_mode};
}

/// Standard deviation of a range l > 0 measured at depth Z (both metres). Eq. (5), in its exact form unless
/// in paper mode: only the disparity carries noise along the ray.
inline double delta_l(const RangeError& error, double l, double Z) {
  return error.per_m2 * l * (error.paper_mode ? l : Z);
}

/// Width m = 3 delta_l of the memberships before and behind the hit, metres; never below the floor, or the
/// triangle of (7) could fall between two cell middles.
inline double membership_width(const RangeError& error, double l, double Z) {
  return std::max(3.0 * delta_l(error, l, Z), error.least_width_m);
}

/// Membership in "empty" of the point at distance r from the camera, in [0, 1]. Eq. (6).
/// l: measured range; m > 0: width; metres.
constexpr double mu_E(double r, double l, double m) {
  if (r < 0 || r >= l) return 0;
  return r < l - m ? 1 : (l - r) / m;
}

/// Membership in "occupied" of the same point, in [0, 1]. Eq. (7).
constexpr double mu_O(double r, double l, double m) {
  if (r < 0 || r < l - m || r >= l + m) return 0;
  return r < l ? 1 - (l - r) / m : 1 - (r - l) / m;
}

}  // namespace flogmap
