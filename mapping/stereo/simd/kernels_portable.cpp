// Plain C++: the reference.
#define FLOGMAP_PORTABLE_LANES
#include "mapping/stereo/simd/kernel_definitions.hpp"

namespace flogmap {

MatchKernels match_kernels_portable(int num_disparities) { return kernels_for("portable", num_disparities); }

}  // namespace flogmap
