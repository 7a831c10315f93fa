#include "mapping/odometry/motion_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace flogmap {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix3x6 = Eigen::Matrix<double, 3, 6>;

constexpr double kNearestZ_m = 1e-3;
constexpr double kMajority = 0.5;  // of the information about a direction of the motion
constexpr int kFewest = 3;         // points that fix a motion

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// One point's residual at a pose, weighed by all errors that it carries.
struct Residual {
  Eigen::Vector3d error;        // seen - predicted, (x, y, d) px
  Eigen::Matrix3d information;  // inverse covariance
  Matrix3x6 jacobian;           // of the prediction, by a left perturbation of the pose
  double squared_sigmas = 0;    // error' information error
};

std::optional<Residual> residual_of(const StereoCamera& camera, const MotionPoint& point, const SE3& pose,
                                    const MotionOptions& options) {
  const Eigen::Vector3d p = pose * point.in_key;
  if (p.z() < kNearestZ_m) return std::nullopt;
  const Eigen::Matrix3d J_p = project_jacobian(camera, p);
  const Eigen::Matrix3d J_key = J_p * pose.linear();
  Eigen::Matrix3d S = J_key * point.covariance * J_key.transpose();
  const double warped = options.view_change_sigma_px * point.view_change;
  const double xy = options.image_sigma_px * options.image_sigma_px + warped * warped;
  S.diagonal() += Eigen::Vector3d(xy, xy, options.disparity_sigma_px * options.disparity_sigma_px);
  Residual r;
  r.error = point.current - project(camera, p);
  r.information = S.inverse();
  r.jacobian << J_p, -J_p * cross_matrix(p);
  r.squared_sigmas = r.error.dot(r.information * r.error);
  return r;
}

/// What a residual of so many standard deviations costs, and the derivatives by its square.
struct Loss {
  double cost = 0, weight = 1, weight_slope = 0;
};

/// Cauchy: logarithmic far beyond k standard deviations.
Loss cauchy(double squared_sigmas, double k) {
  const double growth = 1 + squared_sigmas / (k * k);
  return {k * k * std::log(growth), 1 / growth, -1 / (k * k * growth * growth)};
}

/// Gauss-Newton's normal equations at one pose.
struct NormalEquations {
  Covariance6 H = Covariance6::Zero();
  Vector6 b = Vector6::Zero();
  double cost = 0;
};

/// What a covariance is made of.
struct Spread {
  Covariance6 information = Covariance6::Zero();  // as if every used point had full weight
  double squared_pull = 0;                        // sum of |weight residual|^2
  double stiffness = 0;  // sum of the traces of the weighted residuals' derivatives by the residuals
  int num_points = 0;
};

class Problem {
 public:
  Problem(const StereoCamera& camera, const std::vector<MotionPoint>& points, const MotionOptions& options)
      : camera_(camera), points_(points), options_(options), used_(points.size(), true) {}

  [[nodiscard]] NormalEquations linearise(const SE3& pose) const {
    NormalEquations n;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!used_[i]) continue;
      const auto r = residual_of(camera_, points_[i], pose, options_);
      if (!r) {
        n.cost += 1e6;  // behind the camera: as bad as can be
        continue;
      }
      const Loss loss = loss_of(*r);
      const Eigen::Matrix<double, 6, 3> JtW = loss.weight * r->jacobian.transpose() * r->information;
      n.H += JtW * r->jacobian;
      n.b += JtW * r->error;
      n.cost += loss.cost;
    }
    return n;
  }

  [[nodiscard]] Spread spread(const SE3& pose) const {
    Spread s;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto r = used_[i] ? residual_of(camera_, points_[i], pose, options_) : std::nullopt;
      if (!r) continue;
      const Loss loss = loss_of(*r);
      s.information += r->jacobian.transpose() * r->information * r->jacobian;
      s.squared_pull += loss.weight * loss.weight * r->squared_sigmas;
      s.stiffness += 3 * loss.weight + 2 * loss.weight_slope * r->squared_sigmas;
      ++s.num_points;
    }
    return s;
  }

  /// Levenberg-Marquardt; the pose it ends at.
  [[nodiscard]] SE3 solve(SE3 pose) const {
    NormalEquations n = linearise(pose);
    double damping = 1e-4;
    for (int i = 0; i < options_.max_iterations; ++i) {
      Covariance6 H = n.H;
      H.diagonal() *= 1 + damping;
      const Vector6 step = H.ldlt().solve(n.b);
      if (!step.allFinite()) break;
      const SE3 moved = small_motion(step) * pose;
      const NormalEquations at_moved = linearise(moved);
      if (at_moved.cost > n.cost) {
        damping *= 10;
        continue;
      }
      pose = moved;
      n = at_moved;
      damping /= 10;
      if (step.norm() < 1e-7) break;
    }
    return pose;
  }

  /// Uses only the points that fit a pose from now on; returns how many they are.
  int keep_inliers(const SE3& pose) {
    const double limit = options_.inlier_sigmas * options_.inlier_sigmas;
    int count = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto r = residual_of(camera_, points_[i], pose, options_);
      used_[i] = r && r->squared_sigmas <= limit;
      count += used_[i] ? 1 : 0;
    }
    return count;
  }

  /// The used point that outweighs all others together in some direction of the motion.
  [[nodiscard]] std::optional<std::size_t> decisive(const SE3& pose) const {
    const Covariance6 covariance = linearise(pose).H.inverse();
    std::optional<std::size_t> most;
    double highest = kMajority;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!used_[i]) continue;
      const double leverage = leverage_above_half(points_[i], pose, covariance);
      if (!(leverage > highest)) continue;
      highest = leverage;
      most = i;
    }
    return most;
  }

  void leave_out(std::size_t i) { used_[i] = false; }

  [[nodiscard]] const std::vector<bool>& used() const { return used_; }

 private:
  [[nodiscard]] Loss loss_of(const Residual& r) const {
    return cauchy(r.squared_sigmas, options_.robust_sigmas);
  }

  /// The largest share that a point has in the information about a direction w of the motion,
  ///   max_w  w'H_i w / w'H w = largest eigenvalue of  A J H^-1 J' A',  A'A = the point's information;
  /// 0 where that cannot be above a half because the eigenvalues' sum is not.
  [[nodiscard]] double leverage_above_half(const MotionPoint& point, const SE3& pose,
                                           const Covariance6& covariance) const {
    const auto r = residual_of(camera_, point, pose, options_);
    if (!r) return 0;
    const Eigen::Matrix3d information = loss_of(*r).weight * r->information;
    const Eigen::Matrix3d prediction = r->jacobian * covariance * r->jacobian.transpose();
    if (!((information * prediction).trace() > kMajority)) return 0;
    const Eigen::Matrix3d A = information.llt().matrixU();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> shares(A * prediction * A.transpose(),
                                                                Eigen::EigenvaluesOnly);
    return shares.eigenvalues().maxCoeff();
  }

  const StereoCamera& camera_;
  const std::vector<MotionPoint>& points_;
  const MotionOptions& options_;
  std::vector<bool> used_;
};

/// Inverse of the information, enlarged for the points' lower weights and if the residuals are larger than
/// promised: an M-estimator's variance is E|psi|^2 / E[psi']^2 times that of least squares (Huber 1981).
/// Nothing if it is singular.
std::optional<Covariance6> covariance_of(const Spread& s) {
  const Eigen::LDLT<Covariance6> ldlt(s.information);
  if (ldlt.info() != Eigen::Success || ldlt.vectorD().minCoeff() < 1e-6) return std::nullopt;
  const double num_residuals = 3.0 * s.num_points, freedom = std::max(num_residuals - 6, 1.0);
  const double stiffness = s.stiffness / num_residuals;
  const double enlarged = s.squared_pull / freedom / (stiffness * stiffness);
  return Covariance6(ldlt.solve(Covariance6::Identity()) * std::max(1.0, enlarged));
}

void leave_out_decisive(Problem& problem, Motion& motion) {
  if (motion.num_inliers <= kFewest) return;
  const auto decisive = problem.decisive(motion.current_from_key);
  if (!decisive) return;
  problem.leave_out(*decisive);
  --motion.num_inliers;
  motion.with_decisive = motion.current_from_key;
  motion.current_from_key = problem.solve(motion.current_from_key);
}

}  // namespace

SE3 small_motion(const Vector6& x) {
  SE3 motion = SE3::Identity();
  const Eigen::Vector3d turn = x.tail<3>();
  const double angle = turn.norm();
  if (angle > 1e-12) motion.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  motion.translation() = x.head<3>();
  return motion;
}

std::optional<SE3> align_points(const std::vector<PointPair>& pairs, const std::vector<double>& weights) {
  if (pairs.size() < 3) return std::nullopt;
  Eigen::Vector3d key_mean = Eigen::Vector3d::Zero(), current_mean = Eigen::Vector3d::Zero();
  double sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    key_mean += weights[i] * pairs[i].in_key;
    current_mean += weights[i] * pairs[i].in_current;
    sum += weights[i];
  }
  key_mean /= sum;
  current_mean /= sum;
  Eigen::Matrix3d W = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    W += weights[i] / sum * (pairs[i].in_current - current_mean) * (pairs[i].in_key - key_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(W, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& spread = svd.singularValues();
  if (!(spread(1) > 1e-6 * spread(0))) return std::nullopt;  // on a line: the turn about it is free
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  SE3 current_from_key = SE3::Identity();
  current_from_key.linear() =
      svd.matrixU() * Eigen::Vector3d(1, 1, handedness).asDiagonal() * svd.matrixV().transpose();
  current_from_key.translation() = current_mean - current_from_key.linear() * key_mean;
  return current_from_key;
}

std::optional<Motion> refine_motion(const StereoCamera& camera, const std::vector<MotionPoint>& points,
                                    const SE3& start, const MotionOptions& options) {
  if (points.size() < kFewest) return std::nullopt;
  Problem problem(camera, points, options);
  Motion motion;
  motion.current_from_key = problem.solve(start);
  for (int pass = 0; pass < 2; ++pass) {  // outliers bend the first solution, and with it who is one
    if (problem.keep_inliers(motion.current_from_key) < kFewest) return std::nullopt;
    motion.current_from_key = problem.solve(motion.current_from_key);
  }
  motion.num_inliers = problem.keep_inliers(motion.current_from_key);
  leave_out_decisive(problem, motion);
  motion.inlier = problem.used();
  const auto covariance = covariance_of(problem.spread(motion.current_from_key));
  if (!covariance) return std::nullopt;
  motion.covariance = *covariance;
  return motion;
}

}  // namespace flogmap
