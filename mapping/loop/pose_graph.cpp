#include "mapping/loop/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "mapping/odometry/motion_solver.hpp"

namespace flogmap {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Triplets = std::vector<Eigen::Triplet<double>>;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// How a left perturbation of the source frame looks from the target frame: for small_motion(x), translation
/// and rotation vector apart.
Covariance6 adjoint(const SE3& target_from_source) {
  Covariance6 A = Covariance6::Zero();
  const Eigen::Matrix3d R = target_from_source.linear();
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = R;
  A.topRightCorner<3, 3>() = cross_matrix(target_from_source.translation()) * R;
  return A;
}

/// The twist x with small_motion(x) = motion.
Vector6 twist_of(const SE3& motion) {
  const Eigen::AngleAxisd turn(motion.linear());
  Vector6 x;
  x << motion.translation(), turn.angle() * turn.axis();
  return x;
}

/// How far the poses are from what an edge measured.
Vector6 error_of(const PoseEdge& edge, const std::vector<SE3>& poses) {
  const SE3 predicted = poses[edge.from].inverse() * poses[edge.to];
  return twist_of(predicted * edge.from_to.inverse());
}

/// Cauchy's weight for edges that may be wrong: a false loop loses its pull the more it is contradicted.
double weight_of(const PoseEdge& edge, double squared_sigmas, double k) {
  return edge.may_be_wrong ? 1 / (1 + squared_sigmas / (k * k)) : 1;
}

class NormalEquations {
 public:
  explicit NormalEquations(int num_poses) : size_(6 * (num_poses - 1)), b_(Eigen::VectorXd::Zero(size_)) {}

  /// Poses move by a left perturbation in their own camera: world_from_pose <- world_from_pose
  /// small_motion(x).
  void add(const PoseEdge& edge, const std::vector<SE3>& poses, double robust_sigmas) {
    const Vector6 error = error_of(edge, poses);
    const Covariance6 information = edge.covariance.ldlt().solve(Covariance6::Identity());
    const double weight = weight_of(edge, error.dot(information * error), robust_sigmas);
    const Covariance6 J_from = -Covariance6::Identity();
    const Covariance6 J_to = adjoint(poses[edge.from].inverse() * poses[edge.to]);
    const Covariance6 W = weight * information;
    add_block(edge.from, edge.from, J_from.transpose() * W * J_from);
    add_block(edge.from, edge.to, J_from.transpose() * W * J_to);
    add_block(edge.to, edge.from, J_to.transpose() * W * J_from);
    add_block(edge.to, edge.to, J_to.transpose() * W * J_to);
    if (edge.from > 0) b_.segment<6>(6 * (edge.from - 1)) -= J_from.transpose() * W * error;
    if (edge.to > 0) b_.segment<6>(6 * (edge.to - 1)) -= J_to.transpose() * W * error;
  }

  [[nodiscard]] Eigen::VectorXd solve() const {
    Eigen::SparseMatrix<double> H(size_, size_);
    H.setFromTriplets(triplets_.begin(), triplets_.end());
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(H).solve(b_);
  }

 private:
  void add_block(int row, int column, const Covariance6& block) {
    if (row == 0 || column == 0) return;  // pose 0 is fixed
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j)
        triplets_.emplace_back(6 * (row - 1) + i, 6 * (column - 1) + j, block(i, j));
    }
  }

  int size_;
  Triplets triplets_;
  Eigen::VectorXd b_;
};

}  // namespace

std::vector<SE3> optimise_poses(std::vector<SE3> world_from_pose, const std::vector<PoseEdge>& edges,
                                const PoseGraphOptions& options) {
  const int n = static_cast<int>(world_from_pose.size());
  if (n < 2) return world_from_pose;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    NormalEquations equations(n);
    for (const PoseEdge& edge : edges) equations.add(edge, world_from_pose, options.robust_sigmas);
    const Eigen::VectorXd step = equations.solve();
    if (!step.allFinite()) break;
    for (int i = 1; i < n; ++i) {
      world_from_pose[i] = world_from_pose[i] * small_motion(step.segment<6>(6 * (i - 1)));
    }
    if (step.lpNorm<Eigen::Infinity>() < 1e-8) break;
  }
  return world_from_pose;
}

}  // namespace flogmap
