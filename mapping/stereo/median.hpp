#pragma once

#include "mapping/view.hpp"

namespace flogmap {

/// Replaces every valid disparity by the median of its 3 x 3 neighbourhood, in which invalid neighbours and
/// those outside the picture count as the pixel itself. Invalid pixels stay invalid. Removes single outliers
/// and keeps edges.
void median_3x3(DisparityImage& disparity, int num_threads);

}  // namespace flogmap
