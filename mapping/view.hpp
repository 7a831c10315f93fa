// What flows between the stages of the mapping: plain values, as in figure 1 of the paper.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "camera/image.hpp"
#include "camera/stereo_camera.hpp"

namespace flogmap {

/// A rigid transform. Named target_from_source, always: p_in_target = target_from_source * p_in_source.
using SE3 = Eigen::Isometry3d;

/// Covariance of a rigid motion; order (translation x y z [m], rotation x y z [rad]), perturbation on the
/// left.
using Covariance6 = Eigen::Matrix<double, 6, 6>;

/// Disparity d = x_l - x_r of every pixel of the left picture, in pixels; NaN where there is no match.
struct DisparityImage {
  Image<float> px;
};

/// A picked view: what the map is fed. `camera` (focal length, baseline) is fixed for a map.
struct View {
  std::int64_t timestamp_ns = 0;
  SE3 world_from_camera = SE3::Identity();  // rectified left camera
  DisparityImage disparity;
  Image<std::uint8_t> left;  // rectified, for the walkthrough
  int segment = 0;           // of the odometry, see Tracking
};

enum class TrackingState : std::uint8_t {
  initialising,  // no key frame yet
  ok,
  weak,  // a pose, but few or badly spread inliers: shown, not mapped
  lost,  // no pose
};

/// A correspondence between the key frame and the current frame, in rectified left-image pixels.
struct Match {
  Eigen::Vector2f key_px;
  Eigen::Vector2f current_px;
  float current_disparity_px = 0;
  bool inlier = false;
};

/// What odometry says of one frame.
struct Tracking {
  TrackingState state = TrackingState::initialising;
  SE3 odometry_from_camera = SE3::Identity();    // meaningful if has_pose()
  Covariance6 covariance = Covariance6::Zero();  // of the motion since the key frame
  std::vector<Match> matches;
  std::vector<Eigen::Vector2f> corners_px;  // of the current left picture
  std::string reason;                       // in words, if weak or lost: "too few corners (12 of 40 needed)"
  bool new_key_frame = false;
  int segment = 0;  // grows when odometry goes on after a loss without knowing where: 0, 1, 2 ...

  [[nodiscard]] bool has_pose() const { return state == TrackingState::ok || state == TrackingState::weak; }
};

/// One pose of the path, in the world.
struct TrajectoryEntry {
  std::int64_t timestamp_ns = 0;
  SE3 world_from_camera = SE3::Identity();  // rectified left camera
  TrackingState state = TrackingState::ok;
  bool mapped = false;  // a view of this pose went into the map
  int segment = 0;      // of the odometry, see Tracking
};

}  // namespace flogmap
