// The kernels themselves, on the Bytes of the instruction set that the including file is compiled for.
// Only from kernels_*.cpp; see byte_lanes.hpp for why nothing of the standard library is used here.
#pragma once

#include "mapping/stereo/simd/byte_lanes.hpp"
#include "mapping/stereo/simd/kernels.hpp"

namespace flogmap {
namespace {

constexpr int kLanes = Bytes::kLanes;

// Registers travel between these functions; a call that is not inlined sends them through memory.
#define FLOGMAP_INLINE [[gnu::always_inline]] inline

/// One pixel of a volume: kVectors registers, lane = disparity index.
template <int kVectors>
struct Lanes {
  Bytes v[kVectors];
};

template <int kVectors>
FLOGMAP_INLINE Lanes<kVectors> load_lanes(const std::uint8_t* from) {
  Lanes<kVectors> out;
  for (int i = 0; i < kVectors; ++i) out.v[i] = load(from + i * kLanes);
  return out;
}

template <int kVectors>
FLOGMAP_INLINE void store_lanes(std::uint8_t* to, const Lanes<kVectors>& a) {
  for (int i = 0; i < kVectors; ++i) store(to + i * kLanes, a.v[i]);
}

/// The least byte, in every lane.
template <int kVectors>
FLOGMAP_INLINE Bytes least_everywhere(const Lanes<kVectors>& a) {
  Bytes m = a.v[0];
  for (int i = 1; i < kVectors; ++i) m = min(m, a.v[i]);
  return min_everywhere(m);
}

template <int kVectors>
FLOGMAP_INLINE int first_lane_equal(const Lanes<kVectors>& a, Bytes value) {
  for (int i = 0; i < kVectors; ++i) {
    if (const int lane = first_equal(a.v[i], value); lane >= 0) return i * kLanes + lane;
  }
  return 0;
}

/// Every lane takes the one below it; lane 0 takes `first`.
template <int kVectors>
FLOGMAP_INLINE Lanes<kVectors> from_below(const Lanes<kVectors>& a, Bytes first) {
  Lanes<kVectors> out;
  for (int i = 0; i < kVectors; ++i) out.v[i] = shift_lanes_up(a.v[i], i == 0 ? first : a.v[i - 1]);
  return out;
}

/// Every lane takes the one above it; the last takes `last`.
template <int kVectors>
FLOGMAP_INLINE Lanes<kVectors> from_above(const Lanes<kVectors>& a, Bytes last) {
  Lanes<kVectors> out;
  for (int i = 0; i < kVectors; ++i) {
    out.v[i] = shift_lanes_down(a.v[i], i + 1 == kVectors ? last : a.v[i + 1]);
  }
  return out;
}

// ---- census -------------------------------------------------------------------------------------------

struct Offset {
  int x, y;
};

// Half of the 5 x 5 window: each of these is compared with its mirror image in the window's centre.
constexpr Offset kMirrored[12] = {{-2, -2}, {-1, -2}, {0, -2}, {1, -2}, {2, -2}, {-2, -1},
                                  {-1, -1}, {0, -1},  {1, -1}, {2, -1}, {-2, 0}, {-1, 0}};
// Every second pixel of the window: each of these is compared with the centre.
constexpr Offset kChecker[12] = {{-2, -2}, {0, -2}, {2, -2}, {-1, -1}, {1, -1}, {-2, 0},
                                 {2, 0},   {-1, 1}, {1, 1},  {-2, 2},  {0, 2},  {2, 2}};

Bytes census_bit(const std::uint8_t* const* rows, int x, int comparison) {
  const bool mirrored = comparison < 12;
  const Offset o = mirrored ? kMirrored[comparison] : kChecker[comparison - 12];
  const int sign = mirrored ? -1 : 0;
  const Bytes a = load(rows[kCensusReachPx + o.y] + x + o.x);
  const Bytes b = load(rows[kCensusReachPx + sign * o.y] + x + sign * o.x);
  return bit_and(less(a, b), splat(static_cast<std::uint8_t>(1 << (comparison % 8))));
}

void census_row(const std::uint8_t* const* rows, int width, std::uint8_t* const* planes) {
  for (int x = 0; x < width; x += kLanes) {
    for (int plane = 0; plane < kCensusPlanes; ++plane) {
      Bytes bits = splat(0);
      for (int i = 0; i < 8; ++i) bits = bit_or(bits, census_bit(rows, x, plane * 8 + i));
      store(planes[plane] + x, bits);
    }
  }
}

// ---- costs --------------------------------------------------------------------------------------------

template <int kVectors>
FLOGMAP_INLINE Lanes<kVectors> hamming(const CensusRow& left, const CensusRow& right, int width, int x) {
  Lanes<kVectors> out;
  const int first = width - 1 - x;
  for (int i = 0; i < kVectors; ++i) out.v[i] = splat(0);
  for (int plane = 0; plane < kCensusPlanes; ++plane) {
    const Bytes bits = splat(left.plane[plane][x]);
    for (int i = 0; i < kVectors; ++i) {
      const Bytes other = load(right.plane[plane] + first + i * kLanes);
      out.v[i] = add(out.v[i], popcount(bit_xor(bits, other)));
    }
  }
  return out;
}

template <int kVectors>
void hamming_row(const CensusRow& left, const CensusRow& right, int width, std::uint8_t* sums) {
  Lanes<kVectors> here = hamming<kVectors>(left, right, width, 0), before = here;
  for (int x = 0; x < width; ++x) {
    const int next_x = x + 1 < width ? x + 1 : x;
    const Lanes<kVectors> next = hamming<kVectors>(left, right, width, next_x);
    std::uint8_t* to = sums + x * (kVectors * kLanes);
    for (int i = 0; i < kVectors; ++i) store(to + i * kLanes, add(add(before.v[i], here.v[i]), next.v[i]));
    before = here;
    here = next;
  }
}

template <int kShift>
void shifted_sum(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, int num_bytes,
                 std::uint8_t* cost) {
  const Bytes half = splat(1 << (kShift - 1));
  for (int i = 0; i < num_bytes; i += kLanes) {
    const Bytes sum = add(add(load(a + i), load(b + i)), load(c + i));
    store(cost + i, shift_bits_right<kShift>(add(sum, half)));
  }
}

// ---- windows of the block matcher ---------------------------------------------------------------------

template <int kVectors>
void sum_along(const std::uint8_t* costs, int width, int step, std::uint8_t* sums) {
  constexpr int kStride = kVectors * kLanes;
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* left = costs + (x < step ? 0 : x - step) * kStride;
    const std::uint8_t* right = costs + (x + step < width ? x + step : width - 1) * kStride;
    for (int i = 0; i < kStride; i += kLanes) {
      store(sums + x * kStride + i, add(add(load(left + i), load(right + i)), load(costs + x * kStride + i)));
    }
  }
}

template <int kVectors>
void two_best_corners(const std::uint8_t* above, const std::uint8_t* below, int width, int reach,
                      std::uint8_t* sums) {
  constexpr int kStride = kVectors * kLanes;
  for (int x = 0; x < width; ++x) {
    const int left = (x < reach ? 0 : x - reach) * kStride;
    const int right = (x + reach < width ? x + reach : width - 1) * kStride;
    for (int i = 0; i < kStride; i += kLanes) {
      const Bytes a = load(above + left + i), b = load(above + right + i);
      const Bytes c = load(below + left + i), d = load(below + right + i);
      const Bytes first = min(a, b), third = min(c, d);  // the second best is the loser of one of these,
      const Bytes losers = min(max(a, b), max(c, d));    // or the loser of the final
      store(sums + x * kStride + i, add(min(first, third), min(max(first, third), losers)));
    }
  }
}

// ---- semi-global paths --------------------------------------------------------------------------------

/// The costs of a path at one pixel, and the least of them in every lane.
template <int kVectors>
struct Path {
  Lanes<kVectors> L;
  Bytes min_L;
};

template <int kVectors>
FLOGMAP_INLINE Path<kVectors> start_of_path() {
  Path<kVectors> out;
  for (int i = 0; i < kVectors; ++i) out.L.v[i] = splat(0);
  out.min_L = splat(0);
  return out;
}

/// One step along a path:  L(d) = C(d) + min(L'(d), L'(d-1) + P1, L'(d+1) + P1, min L' + P2) - min L'.
/// With costs up to 27 and P2 up to 90, L stays below 118; padding lanes are 255 and never win.
template <int kVectors>
FLOGMAP_INLINE Path<kVectors> path_step(const Path<kVectors>& path, const Lanes<kVectors>& C,
                                        const Lanes<kVectors>& padding, Bytes P1, Bytes P2) {
  Lanes<kVectors> stepped;
  for (int i = 0; i < kVectors; ++i) stepped.v[i] = add_saturated(path.L.v[i], P1);
  const Lanes<kVectors> below = from_below(stepped, splat(255)), above = from_above(stepped, splat(255));
  const Bytes jumped = add(path.min_L, P2);
  Path<kVectors> out;
  for (int i = 0; i < kVectors; ++i) {
    const Bytes cheapest = min(min(path.L.v[i], jumped), min(below.v[i], above.v[i]));
    out.L.v[i] = bit_or(add(C.v[i], subtract(cheapest, path.min_L)), padding.v[i]);
  }
  out.min_L = least_everywhere(out.L);
  return out;
}

template <int kVectors>
void path_down(const std::uint8_t* costs, int width, const std::uint8_t* padding_lanes,
               const PathPenalties& penalties, const PathRow& before, const PathRow& here) {
  const Lanes<kVectors> padding = load_lanes<kVectors>(padding_lanes);
  const Bytes P1 = splat(penalties.small_step);
  for (int x = 0; x < width; ++x) {
    const int at = x * kVectors * kLanes;
    const Path<kVectors> path{load_lanes<kVectors>(before.costs + at), splat(before.minima[x])};
    const Path<kVectors> next =
        path_step(path, load_lanes<kVectors>(costs + at), padding, P1, splat(penalties.jumps[x]));
    store_lanes(here.costs + at, next.L);
    here.minima[x] = first_byte(next.min_L);
  }
}

template <int kVectors>
FLOGMAP_INLINE void add_lanes(std::uint8_t* to, const Lanes<kVectors>& a) {
  for (int i = 0; i < kVectors; ++i) store(to + i * kLanes, add_saturated(load(to + i * kLanes), a.v[i]));
}

/// Both directions at once: every step waits for the one before, so two chains take the time of one.
template <int kVectors>
void paths_along(const std::uint8_t* costs, int width, const std::uint8_t* padding_lanes,
                 const PathPenalties& penalties, std::uint8_t* sums) {
  constexpr int kStride = kVectors * kLanes;
  const Lanes<kVectors> padding = load_lanes<kVectors>(padding_lanes);
  const Bytes P1 = splat(penalties.small_step);
  Path<kVectors> right = start_of_path<kVectors>(), left = right;
  for (int x = 0; x < width; ++x) {
    const int y = width - 1 - x;  // where the path to the left is
    right =
        path_step(right, load_lanes<kVectors>(costs + x * kStride), padding, P1, splat(penalties.jumps[x]));
    left = path_step(left, load_lanes<kVectors>(costs + y * kStride), padding, P1,
                     splat(penalties.jumps[y + 1]));
    if (x < y) {  // first to come here
      store_lanes(sums + x * kStride, right.L);
      store_lanes(sums + y * kStride, left.L);
    } else if (x == y) {
      store_lanes(sums + x * kStride, right.L);
      add_lanes(sums + x * kStride, left.L);
    } else {
      add_lanes(sums + x * kStride, right.L);
      add_lanes(sums + y * kStride, left.L);
    }
  }
}

// ---- winner takes all ---------------------------------------------------------------------------------

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

// ---- choice by number of disparities -------------------------------------------------------------------

template <int kVectors>
MatchKernels kernels_of_size(const char* name) {
  return {name,
          kVectors * kLanes,
          census_row,
          hamming_row<kVectors>,
          shifted_sum<3>,
          sum_along<kVectors>,
          shifted_sum<1>,
          two_best_corners<kVectors>,
          path_down<kVectors>,
          paths_along<kVectors>,
          winners_row<kVectors>};
}

MatchKernels kernels_for(const char* name, int num_disparities) {
  const int vectors = (num_disparities + kLanes - 1) / kLanes;
  constexpr int kMost = kMaxVolumeLanes / kLanes;
  if (vectors <= 1) return kernels_of_size<1>(name);
  if (vectors <= 2) return kernels_of_size<2>(name);
  if (vectors <= 3) return kernels_of_size<3>(name);
  if (vectors <= 4) return kernels_of_size<4>(name);
  if constexpr (kMost >= 8) {
    if (vectors <= 6) return kernels_of_size<6>(name);
    if (vectors <= 8) return kernels_of_size<8>(name);
  }
  if constexpr (kMost >= 16) {
    if (vectors <= 12) return kernels_of_size<12>(name);
  }
  return kernels_of_size<kMost>(name);
}

}  // namespace
}  // namespace flogmap
