// The camera's unconstrained motion from stereo alone, after reference [2] of the paper. FLOG.md section 9.
#pragma once

#include <memory>

#include "camera/stereo_camera.hpp"
#include "camera/stereo_frame.hpp"
#include "mapping/odometry/features.hpp"
#include "mapping/odometry/placement.hpp"
#include "mapping/view.hpp"

namespace flogmap {

struct OdometryOptions {
  CornerOptions corners;
  PlacementOptions placement;
  int max_landmarks = 250;         // followed at a time
  int min_corners = 25;            // with disparity; fewer: the frame cannot be placed
  int weak_inliers = 20;           // fewer: weak
  double weak_sigma_m = 0.06;      // of the position; larger: weak
  double key_frame_overlap = 0.6;  // a new key frame when a smaller share of the last one's landmarks is seen
  int max_key_frames = 8;          // that are remembered
  int max_lost_frames = 5;         // frames with corners but no pose before a new segment starts
};

/// Follows the rectified left camera. Call track() with every frame in order; one thread only. There is no
/// random choice and no thread inside: the same frames give the same bits.
///
/// The first frame with enough corners is the origin: odometry_from_camera = identity. A frame that cannot be
/// placed is lost: it has no pose, only a reason in words. Later frames are tried against the recent key
/// frames; after `max_lost_frames` a new segment starts at the last known pose, says so in `reason`, and is
/// weak.
class StereoOdometry {
 public:
  /// Throws std::runtime_error naming the field if the camera or an option is impossible.
  StereoOdometry(const OdometryOptions& options, const StereoCamera& camera);
  ~StereoOdometry();
  StereoOdometry(StereoOdometry&&) noexcept;
  StereoOdometry& operator=(StereoOdometry&&) noexcept;

  /// The pose of this frame, its matches with the key frame and how sure that is.
  /// `disparity` belongs to frame.left and has its size.
  [[nodiscard]] Tracking track(const RectifiedFrame& frame, const DisparityImage& disparity);

  /// Forgets everything: the next frame is the first again.
  void reset();

 private:
  class Tracker;
  std::unique_ptr<Tracker> tracker_;
};

}  // namespace flogmap
