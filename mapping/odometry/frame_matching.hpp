// The motion between two frames from their corners alone: no prediction, no earlier pose. FLOG.md section 9.
#pragma once

#include <optional>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/odometry/consistency.hpp"
#include "mapping/odometry/frame_features.hpp"
#include "mapping/view.hpp"

namespace flogmap {

struct MatchingOptions {
  double max_difference = 0.6;  // of two descriptors, standard deviations of a patch, mean over its samples
  int min_consistent = 12;      // correspondences that must agree with one another
};

/// Two frames of which the left pictures are at hand as well.
struct MatchableFrame {
  const Image<std::uint8_t>& left;
  const FrameFeatures& features;
};

struct FrameMatch {
  std::optional<SE3> current_from_key;  // good to a pixel or so; nothing if too few agree or on a line
  std::optional<SE3> rival;  // another one: what a pair asks for that outweighs all others together
  std::vector<IndexPair> pairs;
  std::vector<int> consistent;  // indices of pairs
};

/// The motion that the largest consistent set of these pairs asks for. `key` and `current`: points in their
/// camera's frame, metres. No motion if the set is smaller than `min_consistent` or on a line.
[[nodiscard]] FrameMatch match_points(const StereoCamera& camera, const std::vector<Eigen::Vector3d>& key,
                                      const std::vector<Eigen::Vector3d>& current,
                                      std::vector<IndexPair> pairs, int min_consistent,
                                      const ConsistencyOptions& consistency);

/// Matches patches either upright, under the rotation constraint of `consistency`, or in their own
/// orientation and enlarged by their nearness, under any rotation.
[[nodiscard]] FrameMatch match_frames(const StereoCamera& camera, const MatchableFrame& key,
                                      const MatchableFrame& current, PatchFrame patches,
                                      const MatchingOptions& matching, const ConsistencyOptions& consistency);

}  // namespace flogmap
