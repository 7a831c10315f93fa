#include "camera/board_calibration/bundle.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "camera/calibration/distortion.hpp"

namespace flogmap {
namespace {

constexpr int kPose = 6;  // rotation vector, then translation
constexpr double kBehindCostPx2 = 1e4;
constexpr double kMinDepthShare = 0.02;  // of the distance; flatter rays are no longer seen
// Lens coefficients that the board does not tell stay near zero: as if each had been seen to be 0 +- 1, worth
// the thousandth part of a pixel's square. It matters for the rational model, whose coefficients trade off.
constexpr double kCoefficientPriorPx2 = 1e-3;

using Derivative = Eigen::Matrix<double, 2, Eigen::Dynamic>;

std::optional<Eigen::Vector2d> project(const CameraIntrinsics& camera, const Eigen::Vector3d& p) {
  if (!(p.z() > kMinDepthShare * p.norm())) return std::nullopt;
  return pixel_from_ray(camera, p);
}

double& parameter(CameraIntrinsics& camera, int index) {
  switch (index) {
    case 0:
      return camera.fx_px;
    case 1:
      return camera.fy_px;
    case 2:
      return camera.cx_px;
    case 3:
      return camera.cy_px;
    default:
      return camera.coefficients[static_cast<std::size_t>(index - 4)];
  }
}

int num_intrinsics(const CameraIntrinsics& camera) {
  return 4 + static_cast<int>(camera.coefficients.size());
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Eigen::Matrix<double, kPose, 1>& by) {
  Eigen::Isometry3d result = pose;
  const Eigen::Vector3d w = by.head<3>();
  if (w.norm() > 0)
    result.linear() = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix() * pose.linear();
  result.translation() += by.tail<3>();
  return result;
}

/// A camera with each parameter changed up and down in turn, and by how much; central differences need no
/// more.
struct Variations {
  std::vector<std::array<CameraIntrinsics, 2>> cameras;
  std::vector<double> step;

  explicit Variations(const CameraIntrinsics& camera) {
    for (int i = 0; i < num_intrinsics(camera); ++i) {
      step.push_back(i < 4 ? 1e-2 : 1e-5);
      std::array<CameraIntrinsics, 2> both{camera, camera};
      parameter(both[0], i) += step.back();
      parameter(both[1], i) -= step.back();
      cameras.push_back(std::move(both));
    }
  }
};

/// d pixel / d point in the camera's frame, by central differences.
std::optional<Eigen::Matrix<double, 2, 3>> point_derivative(const CameraIntrinsics& camera,
                                                            const Eigen::Vector3d& p) {
  const double h = 1e-6 * p.norm();
  Eigen::Matrix<double, 2, 3> J;
  for (int axis = 0; axis < 3; ++axis) {
    const auto up = project(camera, p + h * Eigen::Vector3d::Unit(axis));
    const auto down = project(camera, p - h * Eigen::Vector3d::Unit(axis));
    if (!up || !down) return std::nullopt;
    J.col(axis) = (*up - *down) / (2 * h);
  }
  return J;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// d (moved(pose, by) * p) / d by at by = 0.
Eigen::Matrix<double, 3, kPose> pose_derivative(const Eigen::Isometry3d& pose, const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, kPose> J;
  J << -cross_matrix(pose.linear() * p), Eigen::Matrix3d::Identity();
  return J;
}

/// The order of the unknowns in the normal equations.
struct Order {
  int intrinsics, size;
  explicit Order(const Bundle& bundle)
      : intrinsics(num_intrinsics(bundle.left)),
        size(2 * intrinsics + kPose + kPose * static_cast<int>(bundle.left_from_board.size())) {}
  [[nodiscard]] int camera(bool right) const { return right ? intrinsics : 0; }
  [[nodiscard]] int right_from_left() const { return 2 * intrinsics; }
  [[nodiscard]] int pair(std::size_t index) const {
    return 2 * intrinsics + kPose * (1 + static_cast<int>(index));
  }
};

struct NormalEquations {
  Eigen::MatrixXd H;  // lower triangle by blocks
  Eigen::VectorXd g;
};

/// One observation's derivatives, as dense blocks with the place of each.
struct Linearised {
  Eigen::Vector2d residual;
  std::array<Derivative, 3> blocks;  // intrinsics, board pose, right from left (empty for the left camera)
};

std::optional<Linearised> linearise(const Bundle& bundle, const std::array<Variations, 2>& variations,
                                    const Observation& seen, const Eigen::Vector3d& point) {
  const CameraIntrinsics& camera = seen.right ? bundle.right : bundle.left;
  const Eigen::Isometry3d& left_from_board = bundle.left_from_board[seen.pair];
  const Eigen::Vector3d in_left = left_from_board * point;
  const Eigen::Vector3d p = seen.right ? Eigen::Vector3d(bundle.right_from_left * in_left) : in_left;
  const auto pixel = project(camera, p);
  const auto J_p = point_derivative(camera, p);
  if (!pixel || !J_p) return std::nullopt;
  Linearised result;
  result.residual = *pixel - seen.pixel;
  const Variations& variation = variations[seen.right ? 1 : 0];
  Derivative& J_intrinsics = result.blocks[0];
  J_intrinsics.resize(2, std::ssize(variation.step));
  for (std::size_t i = 0; i < variation.step.size(); ++i) {
    J_intrinsics.col(static_cast<Eigen::Index>(i)) =
        (pixel_from_ray(variation.cameras[i][0], p) - pixel_from_ray(variation.cameras[i][1], p)) /
        (2 * variation.step[i]);
  }
  if (seen.right) {
    result.blocks[1] = *J_p * bundle.right_from_left.linear() * pose_derivative(left_from_board, point);
    result.blocks[2] = *J_p * pose_derivative(bundle.right_from_left, in_left);
  } else {
    result.blocks[1] = *J_p * pose_derivative(left_from_board, point);
  }
  return result;
}

/// Weight of Huber's loss for a residual of this length.
double huber_weight(double length_px, double huber_px) {
  return length_px <= huber_px ? 1 : huber_px / length_px;
}
double huber_cost(double length_px, double huber_px) {
  return length_px <= huber_px ? length_px * length_px : huber_px * (2 * length_px - huber_px);
}

NormalEquations normal_equations(const Bundle& bundle, const std::vector<Observation>& observations,
                                 const std::vector<Eigen::Vector3d>& board, double huber_px) {
  const Order order(bundle);
  NormalEquations equations{Eigen::MatrixXd::Zero(order.size, order.size), Eigen::VectorXd::Zero(order.size)};
  const std::array variations{Variations(bundle.left), Variations(bundle.right)};
  for (const Observation& seen : observations) {
    const auto linear = linearise(bundle, variations, seen, board[static_cast<std::size_t>(seen.point)]);
    if (!linear) continue;
    const double weight = huber_weight(linear->residual.norm(), huber_px);
    const std::array at{order.camera(seen.right), order.pair(seen.pair), order.right_from_left()};
    for (std::size_t a = 0; a < 3; ++a) {
      const Derivative& J_a = linear->blocks[a];
      if (J_a.cols() == 0) continue;
      equations.g.segment(at[a], J_a.cols()) += weight * J_a.transpose() * linear->residual;
      for (std::size_t b = 0; b < 3; ++b) {
        const Derivative& J_b = linear->blocks[b];
        if (J_b.cols() == 0 || at[b] > at[a]) continue;
        equations.H.block(at[a], at[b], J_a.cols(), J_b.cols()) += weight * J_a.transpose() * J_b;
      }
    }
  }
  for (const bool right : {false, true}) {
    for (int i = 4; i < order.intrinsics; ++i) {
      const int at = order.camera(right) + i;
      const auto& coefficients = (right ? bundle.right : bundle.left).coefficients;
      equations.H(at, at) += kCoefficientPriorPx2;
      equations.g(at) += kCoefficientPriorPx2 * coefficients[static_cast<std::size_t>(i - 4)];
    }
  }
  return equations;
}

double cost_of(const Bundle& bundle, const std::vector<Observation>& observations,
               const std::vector<Eigen::Vector3d>& board, double huber_px) {
  double sum = 0;
  for (const CameraIntrinsics* camera : {&bundle.left, &bundle.right}) {
    if (!(camera->fx_px > 0) || !(camera->fy_px > 0)) return std::numeric_limits<double>::infinity();
    for (const double k : camera->coefficients) sum += kCoefficientPriorPx2 * k * k;
  }
  for (const Observation& seen : observations) {
    const auto pixel = predict(bundle, seen, board[static_cast<std::size_t>(seen.point)]);
    const double length = pixel ? (*pixel - seen.pixel).norm() : 0;
    sum += pixel && std::isfinite(length) ? huber_cost(length, huber_px) : kBehindCostPx2;
  }
  return sum / static_cast<double>(std::max<std::size_t>(observations.size(), 1));
}

Bundle stepped(const Bundle& bundle, const Eigen::VectorXd& step) {
  const Order order(bundle);
  Bundle result = bundle;
  for (int i = 0; i < order.intrinsics; ++i) {
    parameter(result.left, i) += step(i);
    parameter(result.right, i) += step(order.camera(true) + i);
  }
  result.right_from_left = moved(bundle.right_from_left, step.segment<kPose>(order.right_from_left()));
  for (std::size_t pair = 0; pair < bundle.left_from_board.size(); ++pair)
    result.left_from_board[pair] = moved(bundle.left_from_board[pair], step.segment<kPose>(order.pair(pair)));
  return result;
}

}  // namespace

std::optional<Eigen::Vector2d> predict(const Bundle& bundle, const Observation& seen,
                                       const Eigen::Vector3d& point_on_board) {
  const Eigen::Vector3d in_left = bundle.left_from_board[seen.pair] * point_on_board;
  return seen.right ? project(bundle.right, bundle.right_from_left * in_left) : project(bundle.left, in_left);
}

double solve(Bundle& bundle, const std::vector<Observation>& observations,
             const std::vector<Eigen::Vector3d>& board, const BundleOptions& options) {
  double damping = 1e-3;
  double cost = cost_of(bundle, observations, board, options.huber_px);
  for (int step = 0; step < options.max_steps; ++step) {
    const NormalEquations equations = normal_equations(bundle, observations, board, options.huber_px);
    bool better = false;
    double gained = 0;
    for (int tries = 0; tries < 8 && !better; ++tries) {
      Eigen::MatrixXd H = equations.H;
      H.diagonal() += damping * H.diagonal() + Eigen::VectorXd::Constant(H.rows(), 1e-12);
      const Bundle candidate = stepped(bundle, H.selfadjointView<Eigen::Lower>().ldlt().solve(-equations.g));
      const double candidate_cost = cost_of(candidate, observations, board, options.huber_px);
      better = candidate_cost < cost;
      damping = better ? std::max(damping / 5, 1e-12) : damping * 8;
      if (!better) continue;
      gained = cost - candidate_cost;
      bundle = candidate;
      cost = candidate_cost;
    }
    if (options.on_step) options.on_step(step);
    if (!better || gained < 1e-10 * cost) break;
  }
  return cost;
}

BundleSigmas sigmas(const Bundle& bundle, const std::vector<Observation>& observations,
                    const std::vector<Eigen::Vector3d>& board, double sigma_px) {
  const Order order(bundle);
  Eigen::MatrixXd H = normal_equations(bundle, observations, board, std::numeric_limits<double>::max()).H;
  H.diagonal().array() += 1e-12;
  const auto solver = H.selfadjointView<Eigen::Lower>().ldlt();
  const auto sigma_along = [&](const Eigen::VectorXd& direction) {
    return sigma_px * std::sqrt(std::max(0.0, direction.dot(solver.solve(direction))));
  };
  Eigen::VectorXd focal = Eigen::VectorXd::Zero(order.size), baseline = focal;
  focal(0) = 1;
  baseline.segment<3>(order.right_from_left() + 3) = bundle.right_from_left.translation().normalized();
  return {sigma_along(focal), sigma_along(baseline)};
}

}  // namespace flogmap
