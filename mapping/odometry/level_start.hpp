// Where the first camera pose stands in the world: z up, floor at z = 0.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/odometry/ground_plane.hpp"
#include "mapping/odometry/surface_patches.hpp"
#include "mapping/view.hpp"

namespace flogmap {

struct LevelOptions {
  GroundOptions ground;
  double max_wait_s = 5;              // for a floor to come into view
  int enough_patches = 300;           // on the floor: decided at once
  int least_patches = 60;             // decided when the wait is over
  double max_tilt_sigma_rad = 0.006;  // a third of a degree
};

/// The world as the start knows it.
struct Level {
  SE3 world_from_odometry = SE3::Identity();
  bool tilt_known = false;    // else the first optical axis was taken to be horizontal
  bool height_known = false;  // else the first camera was put at z = 0
  std::string how;            // in words, for the log
};

/// The world whose z axis is `up` (unit length, odometry frame), whose x axis is the first camera's optical
/// axis laid flat, and in which that camera stands at (0, 0, height_m).
[[nodiscard]] SE3 level_from_up(const Eigen::Vector3d& up_in_odometry, double height_m);

/// The world of a camera that is held level: its z (forward) is x, its x (right) is -y, its y (down) is -z.
[[nodiscard]] SE3 level_of_camera();

/// Watches the first frames until it knows. With a measured up (gravity) only the height is sought.
class LevelStart {
 public:
  LevelStart(const StereoCamera& camera, const LevelOptions& options,
             std::optional<Eigen::Vector3d> up_in_first_camera = std::nullopt);

  /// Takes a tracked frame in. Nothing while undecided: after `max_wait_s` it is always decided.
  [[nodiscard]] std::optional<Level> add(std::int64_t timestamp_ns, const DisparityImage& disparity,
                                         const SE3& odometry_from_camera);

  /// What is known by now; for a source that ends early.
  [[nodiscard]] Level decide_now() const;

 private:
  [[nodiscard]] std::optional<GroundPlane> ground() const;

  StereoCamera camera_;
  LevelOptions options_;
  std::optional<Eigen::Vector3d> measured_up_;
  std::vector<SurfacePatch> patches_;  // odometry frame
  std::optional<std::int64_t> first_ns_;
};

}  // namespace flogmap
