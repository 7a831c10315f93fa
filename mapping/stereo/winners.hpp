// From the winners of a row's costs to its disparities: left/right check and sub-pixel fit.
#pragma once

#include <cstdint>
#include <vector>

#include "mapping/stereo/simd/kernels.hpp"

namespace flogmap {

/// The memory behind a WinnersRow.
class WinnersBuffer {
 public:
  WinnersBuffer(int width, int stride);
  [[nodiscard]] WinnersRow row();

 private:
  int width_;
  std::vector<std::uint8_t> bytes_;
};

struct DisparityRange {
  int min_disparity = 0;
  int num_disparities = 0;
};

/// Disparities of one row, NaN where the right picture disagrees by more than `max_left_right_px`, where the
/// match lies outside it, and at the nearest disparity of the range, beyond which a better match may lie.
/// Between whole disparities the costs are taken as two straight lines of the same slope.
void row_disparities(const WinnersRow& winners, int width, DisparityRange range, int max_left_right_px,
                     float* disparity);

}  // namespace flogmap
