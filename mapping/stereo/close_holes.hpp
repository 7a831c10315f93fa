#pragma once

#include "mapping/view.hpp"

namespace flogmap {

/// Closes small holes within one surface: at most 100 invalid pixels that hang together (4 neighbours), do
/// not touch the rim of the picture, and whose neighbours all have the same disparity within 1 px. A hole
/// gets the mean of what lies between its ends along the row and along the column, which is exact on a plane.
/// Everything else stays as it is: occlusions and holes between two surfaces are never filled.
void close_holes(DisparityImage& disparity);

}  // namespace flogmap
