// Where a landmark is, from all key frames that saw it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/odometry/stereo_pixel.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// A landmark as a camera with a known pose saw it.
struct PlacedSighting {
  SE3 camera_from_odometry = SE3::Identity();
  StereoPixel pixel;
  double view_change = 0;  // see Sighting
};

struct LandmarkPoint {
  Eigen::Vector3d in_odometry;  // metres
  Eigen::Matrix3d covariance;   // the poses taken as exact
};

/// The point that these sightings ask for: the structure of a bundle adjustment, the poses held. The first
/// sighting is the anchor's, which the patch comes from; without others there is nothing to adjust. Wrong
/// sightings among them lose their weight (Cauchy's loss). Nothing if the point is not before every camera or
/// the sightings do not determine it.
///
/// What a patch shows from elsewhere is not quite the thing that the anchor saw (wrong slant, an edge of
/// depth). All later sightings share that error, so it counts as the anchor's; each has a smaller one of its
/// own.
[[nodiscard]] std::optional<LandmarkPoint> refine_point(const StereoCamera& camera,
                                                        const std::vector<PlacedSighting>& sightings,
                                                        const Eigen::Vector3d& start,
                                                        double disparity_sigma_px);

}  // namespace flogmap
