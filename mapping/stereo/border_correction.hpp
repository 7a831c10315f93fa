#pragma once

#include "camera/stereo_frame.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// Border correction: depth edges go back to the edges of the picture from where windows smeared them.
///
/// A window with a strong edge of the picture in it matches at the disparity of that edge, so that the nearer
/// surface seems to reach beyond its border, by up to half a window. Wherever two answers side by side (or
/// one above the other) differ, the pixels of the nearer one get the disparity of the farther one as far as
/// the strongest brightness step within 5 px, if that step is clearly stronger than the one at the depth edge
/// and every pixel in between matches at the farther disparity as well as at its own.
///
/// Depth edges without such a step stay where they are, NaN stays NaN. `disparity` (px) has the size of both
/// pictures.
void correct_borders(DisparityImage& disparity, const RectifiedFrame& pair);

}  // namespace flogmap
