// Compiled with -msse4.2.
#include "mapping/stereo/simd/kernel_definitions.hpp"

namespace flogmap {

MatchKernels match_kernels_sse4(int num_disparities) { return kernels_for("sse4", num_disparities); }

}  // namespace flogmap
