// Matching costs of small windows. Only from kernel_definitions.hpp.
#pragma once

#include "mapping/stereo/simd/kernels.hpp"
#include "mapping/stereo/simd/lanes.hpp"

namespace flogmap {
namespace {

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

}  // namespace
}  // namespace flogmap
