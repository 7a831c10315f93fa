#pragma once

#include <cstdint>

#include "camera/image.hpp"

namespace flogmap {

/// A pair as captured, before rectification. Time is the source's own, in nanoseconds.
struct StereoFrame {
  std::int64_t timestamp_ns = 0;
  Picture left;
  Picture right;
};

/// A rectified pair: grey, rows are epipolar. A type of its own, so that raw pictures cannot reach a matcher.
struct RectifiedFrame {
  std::int64_t timestamp_ns = 0;
  Image<std::uint8_t> left;
  Image<std::uint8_t> right;
};

}  // namespace flogmap
