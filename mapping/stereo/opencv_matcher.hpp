// OpenCV's matchers behind our interface.
#pragma once

#include <memory>

#include "mapping/stereo/disparity_matcher.hpp"

namespace flogmap {

/// StereoBM for `block`, StereoSGBM (3-way) for `sgm`. `num_disparities` must be given.
std::unique_ptr<DisparityMatcher> make_opencv_matcher(const StereoOptions& options);

}  // namespace flogmap
