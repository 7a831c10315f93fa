#include "mapping/odometry/level_start.hpp"

#include <cmath>
#include <cstdio>

namespace flogmap {
namespace {

constexpr double kGravityTolerance_rad = 0.1;  // between a measured up and a floor's normal

Eigen::Vector3d camera_up() { return -Eigen::Vector3d::UnitY(); }

std::string described(const char* what, const GroundPlane& plane) {
  char text[120];
  std::snprintf(text, sizeof text, "%s, the camera %.2f m above the floor (%d pieces)", what, plane.height_m,
                plane.num_patches);
  return text;
}

}  // namespace

SE3 level_from_up(const Eigen::Vector3d& up_in_odometry, double height_m) {
  const Eigen::Vector3d z = up_in_odometry.normalized();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();
  if (std::abs(forward.dot(z)) > 0.99)
    forward = camera_up();  // looking straight down: the picture's upper side
  const Eigen::Vector3d x = (forward - forward.dot(z) * z).normalized();
  SE3 world_from_odometry = SE3::Identity();
  world_from_odometry.linear() << x.transpose(), z.cross(x).transpose(), z.transpose();
  world_from_odometry.translation() = Eigen::Vector3d(0, 0, height_m);
  return world_from_odometry;
}

SE3 level_of_camera() { return level_from_up(camera_up(), 0); }

LevelStart::LevelStart(const StereoCamera& camera, const LevelOptions& options,
                       std::optional<Eigen::Vector3d> up_in_first_camera)
    : camera_(camera), options_(options), measured_up_(std::move(up_in_first_camera)) {
  if (!measured_up_) return;
  measured_up_->normalize();
  options_.ground.max_tilt_rad = kGravityTolerance_rad;
}

std::optional<GroundPlane> LevelStart::ground() const {
  return find_ground(patches_, measured_up_.value_or(camera_up()), options_.ground);
}

std::optional<Level> LevelStart::add(std::int64_t timestamp_ns, const DisparityImage& disparity,
                                     const SE3& odometry_from_camera) {
  if (!first_ns_) first_ns_ = timestamp_ns;
  for (SurfacePatch patch : surface_patches(camera_, disparity)) {
    patch.centre = odometry_from_camera * patch.centre;
    patch.normal = odometry_from_camera.linear() * patch.normal;
    patches_.push_back(patch);
  }
  if (static_cast<double>(timestamp_ns - *first_ns_) * 1e-9 >= options_.max_wait_s) return decide_now();
  const auto plane = ground();
  const bool sure = plane && plane->num_patches >= options_.enough_patches &&
                    plane->tilt_sigma_rad <= options_.max_tilt_sigma_rad;
  return sure ? std::optional(decide_now()) : std::nullopt;
}

Level LevelStart::decide_now() const {
  const auto plane = ground();
  const bool found = plane && plane->num_patches >= options_.least_patches;
  if (measured_up_) {
    if (!found)
      return {level_from_up(*measured_up_, 0), true, false, "level by gravity; no floor in view, height 0"};
    return {level_from_up(*measured_up_, plane->height_m), true, true, described("level by gravity", *plane)};
  }
  if (!found)
    return {level_of_camera(), false, false,
            "no floor in view: the first optical axis is taken as level, height 0"};
  return {level_from_up(plane->up, plane->height_m), true, true, described("level by the floor", *plane)};
}

}  // namespace flogmap
