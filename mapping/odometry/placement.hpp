// Where the current frame stands: hypotheses from corners, each tested on the landmarks.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "mapping/odometry/consistency.hpp"
#include "mapping/odometry/frame_matching.hpp"
#include "mapping/odometry/local_map.hpp"
#include "mapping/odometry/motion_solver.hpp"

namespace flogmap {

struct PlacementOptions {
  MatchingOptions matching;
  ConsistencyOptions consistency;
  MotionOptions motion;
  double search_radius_px = 4;    // around the place where a hypothesis puts a landmark
  double max_sigma_m = 0.25;      // of the position: a pose less certain,
  double max_sigma_rad = 0.03;    // or turned by an angle less certain, is none
  int min_inliers = 12;           // fewer: not placed
  int many_inliers = 100;         // a pose with that many is not doubted,
  int convincing_inliers = 30;    // nor one with this many,
  double convincing_share = 0.3;  // if they are this share of the landmarks that should be seen
};

/// A pose of the current frame and the landmarks that speak for it.
struct Placement {
  SE3 odometry_from_camera = SE3::Identity();
  Covariance6 covariance = Covariance6::Zero();  // of its inverse, perturbation on the left
  std::vector<Sighting> sightings;
  std::vector<bool> inlier;  // one per sighting
  int num_inliers = 0;
  bool one_decided = false;          // a landmark outweighed all others together, and was left out
  std::vector<std::int64_t> missed;  // landmarks that should be seen, but are not

  /// Standard deviations of the camera's position and orientation.
  [[nodiscard]] double sigma_m() const { return std::sqrt(covariance.diagonal().head<3>().sum()); }
  [[nodiscard]] double sigma_rad() const { return std::sqrt(covariance.diagonal().tail<3>().sum()); }

  /// Of the landmarks that should be seen, how many are and fit.
  [[nodiscard]] double share() const {
    const std::size_t num_expected = sightings.size() + missed.size();
    return num_expected > 0 ? num_inliers / static_cast<double>(num_expected) : 0;
  }
};

/// A placement, or why there is none.
struct PlacementResult {
  std::optional<Placement> placement;
  std::string reason;
};

/// Tries `known` frames in their order, first upright, then turned, then the last known pose, until one
/// convinces or two of them say the same; else the one with most inliers, if they are enough.
[[nodiscard]] PlacementResult place(const StereoCamera& camera, const LocalMap& map,
                                    const RectifiedFrame& frame, const FrameFeatures& features,
                                    const std::vector<const KeyFrame*>& known,
                                    const SE3& last_odometry_from_camera, const PlacementOptions& options);

}  // namespace flogmap
