// A frame that later ones are measured against.
#pragma once

#include <cstdint>
#include <vector>

#include "mapping/odometry/frame_features.hpp"
#include "mapping/odometry/frame_matching.hpp"
#include "mapping/odometry/landmark.hpp"
#include "mapping/view.hpp"

namespace flogmap {

struct KeyFrame {
  std::int64_t id = 0;
  SE3 odometry_from_camera = SE3::Identity();
  Image<std::uint8_t> left;  // for patches in their own orientation, described only when needed
  FrameFeatures features;
  std::vector<Sighting> sightings;  // of landmarks, new ones included

  [[nodiscard]] MatchableFrame matchable() const { return {left, features}; }
};

}  // namespace flogmap
