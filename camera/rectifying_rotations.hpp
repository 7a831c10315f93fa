#pragma once

#include <Eigen/Geometry>

namespace flogmap {

/// Turns of both raw cameras after which the baseline is the x axis of both, so that rows are epipolar.
struct RectifyingRotations {
  Eigen::Matrix3d rectified_from_left, rectified_from_right;
};

/// Each camera takes half of the rotation between them, then both turn until the baseline is the x axis
/// (Bouguet's method: the two turns, and so the loss at the borders, are as small as they can be).
[[nodiscard]] RectifyingRotations rectifying_rotations(const Eigen::Isometry3d& right_from_left);

}  // namespace flogmap
