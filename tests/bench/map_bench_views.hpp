#pragma once

#include <string>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// Views of one place with exact disparities, and the camera that saw them.
struct BenchViews {
  std::string name;
  StereoCamera camera;
  std::vector<View> views;
};

/// A walk through a furnished room of 6 x 5 m, 752x480, camera in the hand: pitched, rolled, never twice
/// alike.
BenchViews room_views(int count);

/// The views of the rendered recording house-dev whose depth is known, 640x480; none if FLOGMAP_DATA lacks
/// it.
BenchViews house_views();

}  // namespace flogmap
