// The census: brightness comparisons around a pixel, as bits. Only from kernel_definitions.hpp.
#pragma once

#include "mapping/stereo/simd/kernels.hpp"
#include "mapping/stereo/simd/lanes.hpp"

namespace flogmap {
namespace {

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

}  // namespace
}  // namespace flogmap
