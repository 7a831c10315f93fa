#pragma once

#include <memory>

#include "mapping/stereo/disparity_matcher.hpp"
#include "mapping/stereo/simd/kernels.hpp"

namespace flogmap {

/// Semi-global matching (Hirschmueller, PAMI 2008) along four paths, on a census cost, all in bytes.
/// `num_disparities` must be given. `kernels` fit it.
std::unique_ptr<DisparityMatcher> make_sgm_matcher(const StereoOptions& options, const MatchKernels& kernels);

}  // namespace flogmap
