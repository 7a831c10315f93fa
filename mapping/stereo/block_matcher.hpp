#pragma once

#include <memory>

#include "mapping/stereo/disparity_matcher.hpp"
#include "mapping/stereo/simd/kernels.hpp"

namespace flogmap {

/// Correlation with five windows (SMW5) after reference [1], FLOG.md section 8, on a census cost, all in
/// bytes. `num_disparities` must be given. `kernels` fit it.
std::unique_ptr<DisparityMatcher> make_block_matcher(const StereoOptions& options,
                                                     const MatchKernels& kernels);

}  // namespace flogmap
