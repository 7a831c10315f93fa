// Poses that many relative measurements agree on best.
#pragma once

#include <vector>

#include "mapping/view.hpp"

namespace flogmap {

/// A measured motion between two poses: from_to = world_from_from^-1 world_from_to, up to noise.
struct PoseEdge {
  int from = 0;
  int to = 0;
  SE3 from_to = SE3::Identity();
  Covariance6 covariance = Covariance6::Identity();  // of from_to, perturbation on the left
  bool may_be_wrong = false;                         // loses weight if the others contradict it
};

struct PoseGraphOptions {
  int max_iterations = 30;
  double robust_sigmas = 3;  // of edges that may be wrong
};

/// The poses with the least sum of squared errors, in standard deviations; Gauss-Newton with a sparse
/// Cholesky factorisation. `world_from_pose` is where it starts; pose 0 stays where it is. Every pose must be
/// connected with pose 0 by edges.
[[nodiscard]] std::vector<SE3> optimise_poses(std::vector<SE3> world_from_pose,
                                              const std::vector<PoseEdge>& edges,
                                              const PoseGraphOptions& options);

}  // namespace flogmap
