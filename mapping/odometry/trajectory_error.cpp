#include "mapping/odometry/trajectory_error.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>

namespace flogmap {
namespace {

constexpr std::int64_t kMaxTimeGap_ns = 10'000'000;
constexpr double kDegPerRad = 180 / std::numbers::pi;

struct PosePair {
  SE3 estimate;
  SE3 truth;
};

std::vector<PosePair> pairs_by_number(const Trajectory& estimate, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  const std::size_t n = std::min(estimate.poses.size(), truth.poses.size());
  for (std::size_t i = 0; i < n; ++i) {
    pairs.push_back({estimate.poses[i].world_from_camera, truth.poses[i].world_from_camera});
  }
  return pairs;
}

std::vector<PosePair> pairs_by_time(const Trajectory& estimate, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  const auto gap = [](const TimedPose& a, const TimedPose& b) {
    return std::abs(a.timestamp_ns - b.timestamp_ns);
  };
  std::size_t j = 0;
  for (const TimedPose& pose : estimate.poses) {
    while (j + 1 < truth.poses.size() && gap(pose, truth.poses[j + 1]) <= gap(pose, truth.poses[j])) ++j;
    if (j >= truth.poses.size() || gap(pose, truth.poses[j]) > kMaxTimeGap_ns) continue;
    pairs.push_back({pose.world_from_camera, truth.poses[j].world_from_camera});
  }
  return pairs;
}

/// The rigid motion that takes the estimated places nearest to the true ones. Umeyama 1991, scale 1.
SE3 best_alignment(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3Xd from(3, pairs.size()), to(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = pairs[i].estimate.translation();
    to.col(static_cast<Eigen::Index>(i)) = pairs[i].truth.translation();
  }
  return SE3(Eigen::umeyama(from, to, false));
}

double angle_of(const SE3& motion) { return Eigen::AngleAxisd(motion.linear()).angle(); }

/// The error of the estimated motion from pose i to pose j.
SE3 motion_error(const std::vector<PosePair>& pairs, std::size_t i, std::size_t j) {
  const SE3 true_motion = pairs[i].truth.inverse() * pairs[j].truth;
  const SE3 estimated_motion = pairs[i].estimate.inverse() * pairs[j].estimate;
  return true_motion.inverse() * estimated_motion;
}

void measure_absolute(const std::vector<PosePair>& pairs, TrajectoryError& error) {
  error.truth_from_estimate = best_alignment(pairs);
  double sum = 0;
  for (const PosePair& pair : pairs) {
    const double gap =
        (error.truth_from_estimate * pair.estimate.translation() - pair.truth.translation()).norm();
    sum += gap * gap;
    error.ate_max_m = std::max(error.ate_max_m, gap);
  }
  error.ate_rmse_m = std::sqrt(sum / static_cast<double>(pairs.size()));
}

void measure_steps(const std::vector<PosePair>& pairs, TrajectoryError& error) {
  double metres = 0, radians = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const SE3 step = motion_error(pairs, i - 1, i);
    metres += step.translation().squaredNorm();
    radians += std::pow(angle_of(step), 2);
  }
  const auto n = static_cast<double>(pairs.size() - 1);
  error.rpe_rmse_m = std::sqrt(metres / n);
  error.rpe_rmse_deg = std::sqrt(radians / n) * kDegPerRad;
  const SE3 end = motion_error(pairs, 0, pairs.size() - 1);
  error.end_error_m = end.translation().norm();
  error.end_error_deg = angle_of(end) * kDegPerRad;
}

std::vector<double> distances_along(const std::vector<PosePair>& pairs) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    along.push_back(along.back() + (pairs[i].truth.translation() - pairs[i - 1].truth.translation()).norm());
  }
  return along;
}

/// As KITTI does it, with pieces that fit the path instead of 100 to 800 m.
void measure_drift(const std::vector<PosePair>& pairs, TrajectoryError& error) {
  const std::vector<double> along = distances_along(pairs);
  error.path_length_m = along.back();
  int num_pieces = 0;
  for (int tenths = 1; tenths <= 8; ++tenths) {
    const double length = along.back() * tenths / 10;
    for (std::size_t i = 0; length > 0.01 && i < pairs.size(); ++i) {
      const auto end = std::lower_bound(along.begin(), along.end(), along[i] + length);
      if (end == along.end()) break;
      const SE3 gap = motion_error(pairs, i, static_cast<std::size_t>(end - along.begin()));
      error.drift_percent += 100 * gap.translation().norm() / length;
      error.drift_deg_per_m += angle_of(gap) * kDegPerRad / length;
      ++num_pieces;
    }
  }
  if (num_pieces == 0) return;
  error.drift_percent /= num_pieces;
  error.drift_deg_per_m /= num_pieces;
}

}  // namespace

TrajectoryError evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth) {
  const bool timed = estimate.timed && truth.timed;
  if (estimate.timed != truth.timed && estimate.poses.size() != truth.poses.size()) {
    throw std::runtime_error(
        std::to_string(estimate.poses.size()) + " estimated and " + std::to_string(truth.poses.size()) +
        " true poses, of which only the " + (truth.timed ? "true" : "estimated") +
        " ones have times: which belong together cannot be told; needed is a times.txt " +
        "beside KITTI poses, or TUM");
  }
  const auto pairs = timed ? pairs_by_time(estimate, truth) : pairs_by_number(estimate, truth);
  if (pairs.size() < 3) {
    throw std::runtime_error("only " + std::to_string(pairs.size()) +
                             " poses of the estimate have a true pose within 10 ms; at least 3 are needed");
  }
  TrajectoryError error;
  error.num_poses = static_cast<int>(pairs.size());
  measure_absolute(pairs, error);
  measure_steps(pairs, error);
  measure_drift(pairs, error);
  return error;
}

}  // namespace flogmap
