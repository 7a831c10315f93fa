// Points that are followed from frame to frame, and how they are found again.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "camera/stereo_frame.hpp"
#include "mapping/odometry/landmark_point.hpp"
#include "mapping/odometry/patch_alignment.hpp"
#include "mapping/odometry/slant.hpp"
#include "mapping/odometry/stereo_pixel.hpp"
#include "mapping/view.hpp"

namespace flogmap {

struct Landmark {
  std::int64_t id = 0;
  PatchSource patch;  // from the key frame where it was first seen, the anchor
  SE3 odometry_from_anchor;
  StereoPixel anchor_pixel;
  Slant slant = Slant::Zero();       // of its surface, in the anchor's picture
  Eigen::Vector3d in_odometry;       // metres
  Eigen::Matrix3d covariance;        // of in_odometry, the poses that it was seen from taken as exact
  std::vector<PlacedSighting> seen;  // by key frames: the anchor first, then the newest
  std::int64_t last_key_frame = 0;   // the newest that saw it
  int num_found = 0;                 // frames that showed it
  int num_missed = 0;                // frames that should have shown it, but did not
};

/// A landmark found in the current frame.
struct Sighting {
  std::int64_t landmark = 0;
  StereoPixel pixel;
  double view_change = 0;  // of its surface's picture against the anchor's, turned alike: Frobenius norm
};

/// A new landmark at a corner of a key frame.
[[nodiscard]] Landmark make_landmark(const StereoCamera& camera, const RectifiedFrame& frame,
                                     const SE3& odometry_from_camera, const StereoPixel& pixel,
                                     const Slant& slant, std::int64_t id, double disparity_sigma_px);

/// Where a pose puts a landmark; nothing unless it is before the camera and well inside both pictures.
[[nodiscard]] std::optional<StereoPixel> expected_pixel(const StereoCamera& camera, const Landmark& landmark,
                                                        const SE3& camera_from_odometry);

/// Looks for a landmark where a pose puts it, within `radius_px`: its patch, warped as the pose says, in the
/// left picture, and what is found there in the right one. Nothing if it is out of the picture, hidden, or
/// does not look like itself.
[[nodiscard]] std::optional<Sighting> find_landmark(const StereoCamera& camera, const RectifiedFrame& frame,
                                                    const Landmark& landmark, const SE3& camera_from_odometry,
                                                    double radius_px);

}  // namespace flogmap
