#pragma once

#include <cstdint>

#include "camera/image.hpp"

namespace flogmap {

/// How a live pair was taken; zeros where nobody knows.
struct CaptureDetails {
  std::int64_t skew_ns = 0;  // right - left
  double exposure_us = 0;    // of the left camera
  double gain = 0;
  bool operator==(const CaptureDetails&) const = default;
};

/// A pair as captured, before rectification. Time is the source's own, in nanoseconds.
struct StereoFrame {
  std::int64_t timestamp_ns = 0;
  Picture left;
  Picture right;
  CaptureDetails details{};
};

/// A rectified pair: grey, rows are epipolar. A type of its own, so that raw pictures cannot reach a matcher.
struct RectifiedFrame {
  std::int64_t timestamp_ns = 0;
  Image<std::uint8_t> left;
  Image<std::uint8_t> right;
};

}  // namespace flogmap
