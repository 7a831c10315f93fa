// Removes the speckle that any matcher leaves; without it the map is full of spikes. FLOG.md section 8.
#pragma once

#include "mapping/view.hpp"

namespace flogmap {

/// Makes every 4-connected patch of fewer than `min_segment_px` pixels invalid (NaN). Neighbours belong to
/// the same patch if their disparities differ by at most `max_step_px`. Linear in the number of pixels.
void remove_small_segments(DisparityImage& disparity, int min_segment_px, float max_step_px = 1);

}  // namespace flogmap
