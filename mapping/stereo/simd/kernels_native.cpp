// What every processor of the family has: SSE2, NEON, or plain C++.
#include "mapping/stereo/simd/kernel_definitions.hpp"

namespace flogmap {

MatchKernels match_kernels_native(int num_disparities) { return kernels_for("native", num_disparities); }

}  // namespace flogmap
