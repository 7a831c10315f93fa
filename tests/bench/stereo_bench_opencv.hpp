// OpenCV's matchers behind our interface, to be measured beside ours.
#pragma once

#include <memory>

#include "mapping/stereo/disparity_matcher.hpp"

namespace flogmap {

enum class OpenCvMode { bm, sgbm_3way, sgbm_hh4 };

/// Borders are added around the pictures, so that the whole width is matched. Runs on one thread.
std::unique_ptr<DisparityMatcher> make_opencv_matcher(OpenCvMode mode, int num_disparities);

}  // namespace flogmap
