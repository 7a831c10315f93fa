// Which correspondences can belong to one rigid motion: the length and the rotation constraint of FLOG.md
// section 9, and the largest set that agrees with itself.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "camera/stereo_camera.hpp"

namespace flogmap {

/// The same point in two camera frames, metres.
struct PointPair {
  Eigen::Vector3d in_key;
  Eigen::Vector3d in_current;
};

struct ConsistencyOptions {
  double image_sigma_px = 0.25;              // De of an unrefined corner
  double num_sigmas = 3;                     // two lengths agree within this many standard deviations
  std::optional<double> max_turn_rad = 0.8;  // theta_max: a direction turns less than this; nothing: any turn
};

/// Standard deviation of the distance of two triangulated points P1, P2 (camera frame, Z > 0), metres.
///   dL = k/L sqrt( Z1^2 (A1+B1+c) + Z2^2 (A2+B2+c) ),  k = De/(f t);  FLOG.md section 9
[[nodiscard]] double length_sigma(const StereoCamera& camera, const Eigen::Vector3d& P1,
                                  const Eigen::Vector3d& P2, double De);

/// Indices, ascending, of the largest mutually consistent set that greedy growth finds: it starts with the
/// pair that agrees with most others and always takes the one that keeps most candidates. No random choice.
[[nodiscard]] std::vector<int> largest_consistent_set(const StereoCamera& camera,
                                                      const std::vector<PointPair>& pairs,
                                                      const ConsistencyOptions& options);

}  // namespace flogmap
