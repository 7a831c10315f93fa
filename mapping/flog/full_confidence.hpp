// How many rays make a cell fully trusted: N_K of eq. (10). FLOG.md section 3.
#pragma once

#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/flog/grid_spec.hpp"

namespace flogmap {

/// N_K of every layer, rounded, >= 1: the rays of one view that cross one fully visible cell at the closest
/// distance Z_c at which it still fits into the picture and the disparity range.
/// Every row_step-th row and column_step-th column is used; max_disparity_px > 0.
std::vector<float> full_confidence_rays(const StereoCamera& camera, const GridSpec& grid,
                                        double max_disparity_px, int row_step, int column_step);

}  // namespace flogmap
