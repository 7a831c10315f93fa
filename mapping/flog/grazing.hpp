// Which pixels see their surface squarely enough to say where it stands.
#pragma once

#include "camera/stereo_camera.hpp"
#include "mapping/flog/grid_spec.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// The view's disparities (pixels) without those of points within the layers' heights whose ray meets its
/// surface at more than `max_incidence_deg` from the surface's normal: NaN there. Such a pixel hangs between
/// an edge and what is behind it, or sees a surface so much from the side that half a pixel across the
/// picture makes an error of its range far above eq. (5). Points below and above the layers only say where it
/// is free and stay: a low camera meets all of the floor at such angles. 90: none is left out.
///
/// A surface of disparity d + g_x dx + g_y dy has the normal (g_x, g_y, (d - g_x u - g_y v)/f), u and v being
/// measured from the principal point, and
///   cos(incidence) = (d/f) / (|normal| |ray|),  ray = (u/f, v/f, 1).
/// Each of g_x and g_y is the flatter one of the slopes to both sides, so that a pixel at the border of a
/// surface belongs to that surface.
[[nodiscard]] DisparityImage without_grazing(const StereoCamera& camera, const GridSpec& grid,
                                             const View& view, double max_incidence_deg);

}  // namespace flogmap
