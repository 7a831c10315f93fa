// The kernels themselves, on the Bytes of the instruction set that the including file is compiled for.
// Only from kernels_*.cpp; see byte_lanes.hpp for why nothing of the standard library is used here.
#pragma once

#include "mapping/stereo/simd/census_kernel.hpp"
#include "mapping/stereo/simd/cost_kernels.hpp"
#include "mapping/stereo/simd/path_kernels.hpp"
#include "mapping/stereo/simd/window_kernels.hpp"
#include "mapping/stereo/simd/winner_kernels.hpp"

namespace flogmap {
namespace {

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
