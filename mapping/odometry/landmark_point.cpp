#include "mapping/odometry/landmark_point.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace flogmap {
namespace {

constexpr double kSigma_px = 0.08;        // of x and y
constexpr double kSharedPerChange = 0.2;  // px for a view change of 1, shared by all later sightings
constexpr double kOwnPerChange = 0.1;     // and of each alone
constexpr double kRobustSigmas = 2;
constexpr double kNearestZ_m = 1e-3;
constexpr int kMaxIterations = 6;

/// Normal equations at one point.
struct Equations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double cost = 0;
};

class PointProblem {
 public:
  PointProblem(const StereoCamera& camera, const std::vector<PlacedSighting>& sightings,
               double disparity_sigma_px)
      : camera_(camera), sightings_(sightings) {
    double most = 0;
    for (const PlacedSighting& s : sightings) most = std::max(most, s.view_change);
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      const double growth = i == 0 ? kSharedPerChange * most : kOwnPerChange * sightings[i].view_change;
      const double xy = 1 / std::hypot(kSigma_px, growth);
      inverse_sigma_.emplace_back(xy, xy, 1 / disparity_sigma_px);
    }
  }

  [[nodiscard]] std::optional<Equations> linearise(const Eigen::Vector3d& point) const {
    Equations e;
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const SE3& pose = sightings_[i].camera_from_odometry;
      const Eigen::Vector3d p = pose * point;
      if (p.z() < kNearestZ_m) return std::nullopt;
      const Eigen::Vector3d residual =
          inverse_sigma_[i].cwiseProduct(sightings_[i].pixel - project(camera_, p));
      const Eigen::Matrix3d J = inverse_sigma_[i].asDiagonal() * project_jacobian(camera_, p) * pose.linear();
      const double growth = 1 + residual.squaredNorm() / (kRobustSigmas * kRobustSigmas);
      e.H += J.transpose() * J / growth;
      e.b += J.transpose() * residual / growth;
      e.cost += std::log(growth);
    }
    return e;
  }

 private:
  const StereoCamera& camera_;
  const std::vector<PlacedSighting>& sightings_;
  std::vector<Eigen::Vector3d> inverse_sigma_;
};

}  // namespace

std::optional<LandmarkPoint> refine_point(const StereoCamera& camera,
                                          const std::vector<PlacedSighting>& sightings,
                                          const Eigen::Vector3d& start, double disparity_sigma_px) {
  const PointProblem problem(camera, sightings, disparity_sigma_px);
  Eigen::Vector3d point = start;
  auto now = problem.linearise(point);
  if (!now) return std::nullopt;
  double damping = 1e-4;
  for (int i = 0; i < kMaxIterations; ++i) {
    Eigen::Matrix3d H = now->H;
    H.diagonal() *= 1 + damping;
    const Eigen::Vector3d step = H.ldlt().solve(now->b);
    const auto moved = problem.linearise(point + step);
    if (!moved || !(moved->cost <= now->cost)) {
      damping *= 10;
      continue;
    }
    const bool settled = now->cost - moved->cost < 1e-6 * now->cost;
    point += step;
    now = moved;
    damping /= 10;
    if (settled) break;
  }
  const Eigen::Matrix3d covariance = now->H.inverse();
  if (!covariance.allFinite()) return std::nullopt;
  return LandmarkPoint{point, covariance};
}

}  // namespace flogmap
