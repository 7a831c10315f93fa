// The census of a pair: 24 brightness comparisons around every pixel, as bits. Costs are then the number of
// comparisons that differ, which exposure, vignetting and gain of the two cameras hardly change.
#pragma once

#include <cstdint>
#include <vector>

#include "camera/stereo_frame.hpp"
#include "mapping/stereo/simd/kernels.hpp"

namespace flogmap {

class CensusPair {
 public:
  /// `kernels.stride` disparities from `min_disparity` on will be asked for. Keeps its memory between calls.
  void compute(const RectifiedFrame& pair, int min_disparity, const MatchKernels& kernels, int num_threads);

  [[nodiscard]] CensusRow left(int y) const { return row(left_, left_width_, y); }

  /// Reversed: entry W-1-x + d belongs to left pixel x and disparity min_disparity + d. Where that lies
  /// outside the picture, the outermost pixel stands in.
  [[nodiscard]] CensusRow right(int y) const { return row(right_, right_width_, y); }

 private:
  static CensusRow row(const std::vector<std::uint8_t>& planes, int width, int y);

  int left_width_ = 0;  // of one plane's row, slack included
  int right_width_ = 0;
  std::vector<std::uint8_t> left_;
  std::vector<std::uint8_t> right_;
};

}  // namespace flogmap
