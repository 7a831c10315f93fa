// The camera's path as text. Frames without a pose (initialising, lost) are left out: no pose is made up.
#pragma once

#include <span>
#include <string>

#include "server/publication.hpp"

namespace flogmap {

/// TUM: `timestamp[s] tx ty tz qx qy qz qw` a line, world_from_camera of the rectified left camera.
std::string tum_of(std::span<const TrajectoryEntry> trajectory);

/// KITTI: the upper 3 x 4 of world_from_camera a line, row by row.
std::string kitti_of(std::span<const TrajectoryEntry> trajectory);

}  // namespace flogmap
