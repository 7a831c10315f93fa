// The least squares problem behind a stereo calibration. Eigen only.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// All unknowns.
struct Bundle {
  CameraIntrinsics left, right;  // same model
  Eigen::Isometry3d right_from_left = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Isometry3d> left_from_board;  // one per pair
};

struct Observation {
  std::size_t pair = 0;
  bool right = false;
  int point = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// Where the bundle says that a board point is seen; nothing if it is behind the camera.
[[nodiscard]] std::optional<Eigen::Vector2d> predict(const Bundle& bundle, const Observation& observation,
                                                     const Eigen::Vector3d& point_on_board);

struct BundleOptions {
  int max_steps = 100;
  double huber_px = 1;  // farther off, a corner pulls with constant force
  std::function<void(int step)> on_step{};
};

/// Moves the bundle to the nearest least squares solution; returns the mean robust cost [px^2].
double solve(Bundle& bundle, const std::vector<Observation>& observations,
             const std::vector<Eigen::Vector3d>& board, const BundleOptions& options);

/// Standard deviations that follow from the curvature at the solution if corners scatter by `sigma_px`.
struct BundleSigmas {
  double left_focal_px = 0;
  double baseline_m = 0;
};
[[nodiscard]] BundleSigmas sigmas(const Bundle& bundle, const std::vector<Observation>& observations,
                                  const std::vector<Eigen::Vector3d>& board, double sigma_px);

}  // namespace flogmap
