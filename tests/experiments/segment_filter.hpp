#pragma once

#include <cstdint>

#include "mapping/stereo/disparity_matcher.hpp"
#include "tests/experiments/scored_map.hpp"

namespace flogmap::experiments {

/// A patch is a 4-connected set of pixels whose disparities differ by at most 1 px from one to the next;
/// wrong, if more than half of it is off by more than 1 px. The rays of a wrong patch end in the air: a
/// spike.
struct WrongPatches {
  int patches = 0;
  std::int64_t pixels = 0;
};
[[nodiscard]] WrongPatches wrong_patches(const DisparityImage& measured, const DisparityImage& exact);

/// Two boxes seen by a noisy sensor (4 grey levels), true poses.
struct FilterOutcome {
  MapSnapshot map;
  WrongPatches in_views;  // all 33
  Spikes in_map;          // more than 5 cm from every solid
  double occupied_f1 = 0;
};
[[nodiscard]] FilterOutcome map_with_filter(MatcherKind matcher, double min_segment_fraction);

}  // namespace flogmap::experiments
