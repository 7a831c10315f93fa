// Winner takes all, seen from both pictures. Only from kernel_definitions.hpp.
#pragma once

#include "mapping/stereo/simd/kernels.hpp"
#include "mapping/stereo/simd/lanes.hpp"

namespace flogmap {
namespace {

/// The right picture's winners. Lane d belongs to right pixel x - d, so all lanes move up with every x.
template <int kVectors>
struct RightWinners {
  Lanes<kVectors> cost, index, own_index;

  FLOGMAP_INLINE RightWinners() {
    std::uint8_t lane[kVectors * kLanes];
    for (int i = 0; i < kVectors * kLanes; ++i) lane[i] = static_cast<std::uint8_t>(i);
    own_index = load_lanes<kVectors>(lane);
    for (int i = 0; i < kVectors; ++i) cost.v[i] = splat(255), index.v[i] = splat(0);
  }

  FLOGMAP_INLINE void add_pixel(const Lanes<kVectors>& S) {
    cost = from_below(cost, splat(255));
    index = from_below(index, splat(0));
    for (int i = 0; i < kVectors; ++i) {
      const Bytes cheaper = less(S.v[i], cost.v[i]);
      cost.v[i] = min(cost.v[i], S.v[i]);
      index.v[i] = select(cheaper, own_index.v[i], index.v[i]);
    }
  }
};

/// The least cost of all lanes but `best` and its neighbours.
template <int kVectors>
FLOGMAP_INLINE std::uint8_t second_best(const Lanes<kVectors>& S, const Lanes<kVectors>& index, int best) {
  Lanes<kVectors> others;
  for (int i = 0; i < kVectors; ++i) {
    const Bytes distance = subtract(index.v[i], splat(static_cast<std::uint8_t>(best - 1)));
    others.v[i] = bit_or(S.v[i], less(distance, splat(3)));
  }
  return first_byte(least_everywhere(others));
}

template <int kVectors>
void winners_row(const std::uint8_t* along, const std::uint8_t* down, const std::uint8_t* up, int width,
                 const std::uint8_t* padding, const WinnersRow& winners) {
  constexpr int kStride = kVectors * kLanes;
  RightWinners<kVectors> right;
  std::uint8_t costs[1 + kStride + 1] = {};
  for (int x = 0; x < width; ++x) {
    Lanes<kVectors> S;
    for (int i = 0; i < kVectors; ++i) {
      const int at = x * kStride + i * kLanes;
      const Bytes vertical = add_saturated(load(down + at), load(up + at));
      S.v[i] = bit_or(average(load(along + at), vertical), load(padding + i * kLanes));
    }
    right.add_pixel(S);
    store_lanes(winners.right + (width - 1 - x),
                right.index);  // later pixels overwrite all but the final lanes
    const Bytes cost = least_everywhere(S);
    const int best = first_lane_equal(S, cost);
    store_lanes(costs + 1, S);
    winners.best[x] = static_cast<std::uint8_t>(best);
    winners.cost[x] = first_byte(cost);
    winners.before[x] = costs[best];
    winners.after[x] = costs[best + 2];
    if (winners.second) winners.second[x] = second_best(S, right.own_index, best);
  }
}

}  // namespace
}  // namespace flogmap
