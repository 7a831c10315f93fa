// Windows of the block matcher. Only from kernel_definitions.hpp.
#pragma once

#include "mapping/stereo/simd/kernels.hpp"
#include "mapping/stereo/simd/lanes.hpp"

namespace flogmap {
namespace {

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

}  // namespace
}  // namespace flogmap
