// All disparities of one pixel: several registers of Bytes. Only from kernel_definitions.hpp.
#pragma once

#include "mapping/stereo/simd/byte_lanes.hpp"

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

}  // namespace
}  // namespace flogmap
