// How far an estimated path is from the true one: ATE, RPE, drift.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "mapping/view.hpp"

namespace flogmap {

struct TimedPose {
  std::int64_t timestamp_ns = 0;
  SE3 world_from_camera = SE3::Identity();
};

/// Poses in strictly increasing time. KITTI poses have no times: they are numbered 0, 1, 2 ... ns.
struct Trajectory {
  std::vector<TimedPose> poses;
  bool timed = true;  // false: the timestamps are only numbers
};

/// Reads a trajectory of any of three kinds, told apart by their first line of numbers:
/// TUM (`timestamp[s] tx ty tz qx qy qz qw`), EuRoC csv (`timestamp[ns], px, py, pz, qw, qx, qy, qz, ...`;
/// poses of the body) and KITTI (12 numbers, rows of [R|T]). Throws std::runtime_error naming file, line and
/// what is allowed.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& file);

/// The same for a true path: KITTI poses get the times that stand in times.txt, beside them or, of
/// poses/NN.txt, in sequences/NN/. Where there is none they stay without. Throws std::runtime_error likewise,
/// also where there are not as many times as poses.
[[nodiscard]] Trajectory read_true_trajectory(const std::filesystem::path& file);

struct TrajectoryError {
  int num_poses = 0;         // of the estimate that found a partner
  double path_length_m = 0;  // of the truth
  double ate_rmse_m = 0;     // after the best SE(3) alignment (Umeyama 1991, no scale)
  double ate_max_m = 0;
  double rpe_rmse_m = 0;  // from one pose to the next
  double rpe_rmse_deg = 0;
  double drift_percent = 0;  // mean over pieces of the path of 1/10, 2/10, ... of its length
  double drift_deg_per_m = 0;
  double end_error_m = 0;  // of the last pose, the first being taken as exact
  double end_error_deg = 0;
  SE3 truth_from_estimate = SE3::Identity();  // the alignment
};

/// Compares by time: each estimated pose with the true one that is nearest in time, at most 10 ms away.
/// Without times on both sides they are taken pose by pose. Throws std::runtime_error if fewer than three
/// pairs are found, or if only one side has times and the other not as many poses.
[[nodiscard]] TrajectoryError evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth);

}  // namespace flogmap
