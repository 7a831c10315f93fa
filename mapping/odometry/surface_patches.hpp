// Small flat pieces of the surfaces that a disparity image shows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// A flat piece of surface, camera frame.
struct SurfacePatch {
  Eigen::Vector3d centre;    // metres
  Eigen::Vector3d normal;    // unit length, towards the camera
  double range_sigma_m = 0;  // of the distance of its plane from the camera
  double area_m2 = 0;        // of the surface, not of the picture
};

/// Fits a plane to every block of up to 32 x 32 px. A plane n.P = -h in space is one in disparity:
///   d = -t/h (n_x x + n_y y + n_z f),  x, y without the principal point
/// Blocks with holes, edges or curved surfaces give none.
[[nodiscard]] std::vector<SurfacePatch> surface_patches(const StereoCamera& camera,
                                                        const DisparityImage& disparity);

}  // namespace flogmap
