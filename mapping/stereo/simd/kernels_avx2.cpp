// Compiled with -mavx2.
#include "mapping/stereo/simd/kernel_definitions.hpp"

namespace flogmap {

MatchKernels match_kernels_avx2(int num_disparities) { return kernels_for("avx2", num_disparities); }

}  // namespace flogmap
