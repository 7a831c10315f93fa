#pragma once

#include "mapping/view.hpp"
#include "tests/bench/stereo_bench_pairs.hpp"

namespace flogmap {

/// Percent unless said otherwise; NaN where there is no truth.
struct StereoScore {
  double density = 0;           // pixels with an answer, of all
  double bad2_visible = 0;      // wrong by more than 2 px or without answer, of the visible pixels
  double bad2_answered = 0;     // wrong by more than 2 px, of the answers whose truth is known
  double bias_px = 0;           // mean error of the answers within 1 px
  double median_px = 0;         // median error of the same
  double spikes_per_10k = 0;    // see below; needs the camera
  double textured_density = 0;  // answers, of the visible pixels on textured surfaces
};

/// A spike: an answer more than 4 px away from every depth edge that is nearer than the truth by more than
/// 3 m, m = 3 dl of FLOG.md sections 1 and 2.
StereoScore score(const DisparityImage& disparity, const BenchPair& pair);

}  // namespace flogmap
