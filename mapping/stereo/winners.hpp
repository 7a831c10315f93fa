// From the winners of a row's costs to its disparities: left/right check and sub-pixel fit.
#pragma once

#include <cstdint>
#include <vector>

#include "mapping/stereo/simd/kernels.hpp"

namespace flogmap {

/// The memory behind a WinnersRow.
class WinnersBuffer {
 public:
  WinnersBuffer(int width, int stride, bool with_second);
  [[nodiscard]] WinnersRow row();

 private:
  int width_;
  bool with_second_;
  std::vector<std::uint8_t> bytes_;
};

/// What an answer must satisfy.
struct WinnersRule {
  int min_disparity = 0;
  int num_disparities = 0;
  int max_left_right_px = 0;  // the right picture's own answer differs by no more
  int max_cost = 255;         // dearer winners are no match at all: too near, too dark, reflected
  int least_lead = 0;         // the second best cost is higher by at least this; needs WinnersRow::second
};

/// Disparities of one row, NaN where the rule is broken, where the match lies outside the right picture, and
/// at the nearest disparity of the range, beyond which a better match may lie.
/// Between whole disparities the costs are taken as two straight lines of the same slope.
void row_disparities(const WinnersRow& winners, int width, const WinnersRule& rule, float* disparity);

}  // namespace flogmap
