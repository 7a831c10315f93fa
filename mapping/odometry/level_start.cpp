#include "mapping/odometry/level_start.hpp"

#include <algorithm>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "mapping/triangulate.hpp"

namespace flogmap {
namespace {

constexpr int kStepPx = 12;           // between the corners of a surfel
constexpr double kMaxDepthStep = 0.15;  // of the depth; a larger step is an edge, not a surface
constexpr double kSameDirection = 0.985;  // cosine of 10 degrees
constexpr std::size_t kMinSurfels = 150;
constexpr double kBinM = 0.04;          // of the histogram of heights
constexpr double kMinFloorShare = 0.12;  // of the level surfels
constexpr double kFloorBandM = 0.08;     // surfels this near belong to the floor
constexpr double kMaxRange = 8;          // in metres; farther surfels are too rough

std::optional<Eigen::Vector3d> point_at(const StereoCamera& camera, const DisparityImage& disparity, int x, int y) {
  const float d = disparity.px.at(x, y);
  if (!(d > 0.5F)) return std::nullopt;  // NaN too
  const Eigen::Vector3d p = triangulate(camera, x, y, static_cast<double>(d));
  if (p.z() > kMaxRange) return std::nullopt;
  return p;
}

}  // namespace

SE3 world_from_level(const Eigen::Vector3d& up_in_odometry, double floor_height_m) {
  const Eigen::Vector3d z = up_in_odometry.normalized();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitZ() - z.z() * z;
  // Looking straight up or down, the upper edge of the picture tells where ahead is.
  if (forward.norm() < 0.1) forward = -Eigen::Vector3d::UnitY() + z.y() * z;
  const Eigen::Vector3d x = forward.normalized();
  SE3 world_from_odometry = SE3::Identity();
  world_from_odometry.linear().row(0) = x;
  world_from_odometry.linear().row(1) = z.cross(x);
  world_from_odometry.linear().row(2) = z;
  world_from_odometry.translation().z() = -floor_height_m;
  return world_from_odometry;
}

LevelStart::LevelStart(const LevelStartOptions& options, const StereoCamera& camera,
                       const std::optional<Eigen::Vector3d>& up_in_camera)
    : options_(options), camera_(camera) {
  if (options.mode == AlignMode::automatic || options.mode == AlignMode::gravity) up_ = up_in_camera;
}

std::optional<SE3> LevelStart::add(const DisparityImage& disparity, const SE3& odometry_from_camera) {
  if (options_.mode == AlignMode::none) {
    decided_by_ = "none";
    return world_from_level(-Eigen::Vector3d::UnitY(), 0);
  }
  collect(disparity, odometry_from_camera);
  ++num_frames_;
  if (num_frames_ < options_.min_frames) return std::nullopt;
  if (num_frames_ % options_.min_frames != 0) return std::nullopt;
  return decide();
}

std::optional<SE3> LevelStart::decide() {
  const std::optional<Eigen::Vector3d> up = up_ ? up_ : dominant_up();
  const std::optional<Plane> floor = up ? find_floor(*up, !up_) : std::nullopt;
  if (floor) {
    decided_by_ = up_ ? "gravity and ground" : "ground";
    return world_from_level(floor->up, floor->height_m);
  }
  if (num_frames_ < options_.max_frames) return std::nullopt;
  if (up_) {
    decided_by_ = "gravity (no floor seen: heights are relative to the first camera)";
    return world_from_level(*up_, 0);
  }
  decided_by_ = "none (no floor seen: the first camera counts as level, heights are relative to it)";
  return world_from_level(-Eigen::Vector3d::UnitY(), 0);
}

void LevelStart::collect(const DisparityImage& disparity, const SE3& odometry_from_camera) {
  for (int y = 0; y + kStepPx < disparity.px.height; y += kStepPx) {
    for (int x = 0; x + kStepPx < disparity.px.width; x += kStepPx) {
      const auto p = point_at(camera_, disparity, x, y);
      const auto right = point_at(camera_, disparity, x + kStepPx, y);
      const auto below = point_at(camera_, disparity, x, y + kStepPx);
      if (!p || !right || !below) continue;
      const double limit = kMaxDepthStep * p->z();
      if (std::abs(right->z() - p->z()) > limit || std::abs(below->z() - p->z()) > limit) continue;
      const Eigen::Vector3d normal = -(*right - *p).cross(*below - *p).normalized();
      surfels_.push_back({odometry_from_camera * *p, odometry_from_camera.linear() * normal});
    }
  }
}

/// The direction that most surfels within reach of "up in the picture" look.
std::optional<Eigen::Vector3d> LevelStart::dominant_up() const {
  const Eigen::Vector3d guess = -Eigen::Vector3d::UnitY();
  std::vector<Eigen::Vector3d> candidates;
  for (const Surfel& surfel : surfels_) {
    if (surfel.normal.dot(guess) > std::cos(options_.max_tilt_rad)) candidates.push_back(surfel.normal);
  }
  if (candidates.size() < kMinSurfels) return std::nullopt;
  const auto sum_near = [&](const Eigen::Vector3d& direction) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& normal : candidates) {
      if (normal.dot(direction) > kSameDirection) sum += normal;
    }
    return sum;
  };
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  const std::size_t stride = std::max<std::size_t>(1, candidates.size() / 200);
  for (std::size_t i = 0; i < candidates.size(); i += stride) {
    const Eigen::Vector3d sum = sum_near(candidates[i]);
    if (sum.norm() > best.norm()) best = sum;
  }
  for (int i = 0; i < 5 && best.norm() > 0; ++i) best = sum_near(best.normalized());
  if (best.norm() < static_cast<double>(kMinSurfels) / 3) return std::nullopt;
  return best.normalized();
}

/// The lowest level that carries a fair share of the level surfels, and the plane through it.
std::optional<LevelStart::Plane> LevelStart::find_floor(const Eigen::Vector3d& given_up, bool refine_up) const {
  Eigen::Vector3d up = given_up;
  double height = 0;
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<double> heights;
    for (const Surfel& surfel : surfels_) {
      if (surfel.normal.dot(up) > 0.9) heights.push_back(surfel.point.dot(up));
    }
    if (heights.size() < kMinSurfels) return std::nullopt;
    std::sort(heights.begin(), heights.end());
    const auto enough = static_cast<std::size_t>(kMinFloorShare * static_cast<double>(heights.size()));
    std::size_t first = 0;
    while (first + enough < heights.size() && heights[first + enough] - heights[first] > 2 * kBinM) ++first;
    if (first + enough >= heights.size()) return std::nullopt;
    height = heights[first + enough / 2];

    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> floor;
    for (const Surfel& surfel : surfels_) {
      if (surfel.normal.dot(up) > 0.9 && std::abs(surfel.point.dot(up) - height) < kFloorBandM) {
        floor.push_back(surfel.point);
        mean += surfel.point;
      }
    }
    if (floor.size() < 3) return std::nullopt;
    mean /= static_cast<double>(floor.size());
    if (refine_up) {
      Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
      for (const Eigen::Vector3d& p : floor) scatter += (p - mean) * (p - mean).transpose();
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
      const Eigen::Vector3d normal = axes.eigenvectors().col(0);
      up = normal.dot(up) > 0 ? normal : -normal;
    }
    height = mean.dot(up);
  }
  if (height > -0.05) return std::nullopt;  // a floor lies below the camera
  return Plane{up, height};
}

}  // namespace flogmap
