// Compiled for AVX-512 BW, VL and BITALG.
#include "mapping/stereo/simd/kernel_definitions.hpp"

namespace flogmap {

MatchKernels match_kernels_avx512(int num_disparities) { return kernels_for("avx512", num_disparities); }

}  // namespace flogmap
