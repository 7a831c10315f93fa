// Semi-global paths. Only from kernel_definitions.hpp.
#pragma once

#include "mapping/stereo/simd/kernels.hpp"
#include "mapping/stereo/simd/lanes.hpp"

namespace flogmap {
namespace {

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

}  // namespace
}  // namespace flogmap
