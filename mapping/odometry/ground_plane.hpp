// The floor among flat pieces of surface.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mapping/odometry/surface_patches.hpp"

namespace flogmap {

/// A floor: up.p + height_m = 0 for its points p, so the origin stands height_m above it.
struct GroundPlane {
  Eigen::Vector3d up;  // unit length
  double height_m = 0;
  double tilt_sigma_rad = 0;  // of up, if the pieces' errors were independent
  int num_patches = 0;        // that lie on it ...
  double area_m2 = 0;         // ... and how large they are together, each sight of a place counted
};

struct GroundOptions {
  double max_tilt_rad = 0.7;       // of the floor's normal from the expected up
  double normal_sigma_rad = 0.07;  // of one piece
  double slab_m = 0.04;            // pieces this near to the plane lie on it
  bool use_walls = true;           // surfaces at a right angle to the floor are taken to be vertical
};

/// The plane with many pieces, not too far from `expected_up`, below the origin; of several floors (a table,
/// the floor) the lowest whose area is not much smaller than the largest's. All in one frame. Nothing if
/// there is none.
[[nodiscard]] std::optional<GroundPlane> find_ground(const std::vector<SurfacePatch>& patches,
                                                     const Eigen::Vector3d& expected_up,
                                                     const GroundOptions& options);

}  // namespace flogmap
