#include "mapping/stereo/winners.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace flogmap {
namespace {

/// Where two lines of the same slope through the three costs meet, px from the middle one, in [-0.5, 0.5].
float v_fit(int before, int cost, int after) {
  const int slope = std::max(before, after) - cost;
  return 0.5F * static_cast<float>(before - after) / static_cast<float>(slope);
}

}  // namespace

WinnersBuffer::WinnersBuffer(int width, int stride, bool with_second)
    : width_(width), with_second_(with_second), bytes_(static_cast<std::size_t>(width) * 6 + stride) {}

WinnersRow WinnersBuffer::row() {
  std::uint8_t* p = bytes_.data();
  return {
      p, p + width_, p + 2 * width_, p + 3 * width_, with_second_ ? p + 4 * width_ : nullptr, p + 5 * width_};
}

void row_disparities(const WinnersRow& winners, int width, const WinnersRule& rule, float* disparity) {
  for (int x = 0; x < width; ++x) {
    const int best = winners.best[x];
    const int right_x = x - best - rule.min_disparity;
    disparity[x] = std::numeric_limits<float>::quiet_NaN();
    if (right_x < 0 || right_x >= width || best + 1 >= rule.num_disparities) continue;
    if (std::abs(winners.right[width - 1 - x + best] - best) > rule.max_left_right_px) continue;
    if (winners.cost[x] > rule.max_cost) continue;
    if (winners.second && winners.second[x] < winners.cost[x] + rule.least_lead) continue;
    const int after = winners.after[x], before = best == 0 ? after : winners.before[x];
    if (std::max(before, after) == winners.cost[x]) continue;  // no texture: any disparity would do
    const float fraction = v_fit(before, winners.cost[x], after);
    disparity[x] = static_cast<float>(rule.min_disparity + best) + fraction;
  }
}

}  // namespace flogmap
