// Which way is up, and how high: the first pose of the world, so that layers mean heights. FLOG.md section 1.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/view.hpp"

namespace flogmap {

enum class AlignMode : std::uint8_t {
  automatic,  // gravity where a sensor tells it, else ground, else none
  none,       // the first optical axis is level and the first camera stands at z = 0
  gravity,
  ground,
};

struct LevelStartOptions {
  AlignMode mode = AlignMode::automatic;
  int min_frames = 10;   // the floor is looked for in so many frames at least ...
  int max_frames = 100;  // ... and given up after so many
  double max_tilt_rad = 0.9;  // of the first camera against the level one; a steeper "floor" is a wall
};

/// Watches the first frames until the world is decided: origin on the floor below the first camera, z up, the
/// first optical axis above the x axis. Pure: the same frames give the same answer.
class LevelStart {
 public:
  /// `up_in_camera`: unit vector against gravity in the rectified left camera of the first frame, if known.
  LevelStart(const LevelStartOptions& options, const StereoCamera& camera,
             const std::optional<Eigen::Vector3d>& up_in_camera);

  /// world_from_odometry once it is decided; call with every tracked frame until then.
  std::optional<SE3> add(const DisparityImage& disparity, const SE3& odometry_from_camera);

  /// In words: "gravity and ground", "ground", "gravity", "none"; with the reason where a wish failed.
  [[nodiscard]] const std::string& decided_by() const { return decided_by_; }

 private:
  /// A small piece of surface, in the odometry's frame.
  struct Surfel {
    Eigen::Vector3d point;
    Eigen::Vector3d normal;  // towards the camera
  };
  struct Plane {
    Eigen::Vector3d up;
    double height_m = 0;  // of the plane along `up`; the odometry's origin is at 0
  };

  void collect(const DisparityImage& disparity, const SE3& odometry_from_camera);
  [[nodiscard]] std::optional<Eigen::Vector3d> dominant_up() const;
  [[nodiscard]] std::optional<Plane> find_floor(const Eigen::Vector3d& up, bool refine_up) const;
  [[nodiscard]] std::optional<SE3> decide();

  LevelStartOptions options_;
  StereoCamera camera_;
  std::optional<Eigen::Vector3d> up_;  // by gravity
  std::vector<Surfel> surfels_;
  int num_frames_ = 0;
  std::string decided_by_ = "undecided";
};

/// The level world whose z axis is `up` and whose floor is at `floor_height_m` along it; see LevelStart.
SE3 world_from_level(const Eigen::Vector3d& up_in_odometry, double floor_height_m);

}  // namespace flogmap
