#pragma once

#include <memory>
#include <optional>
#include <string>

#include "camera/stereo_source.hpp"

namespace flogmap {

/// What a video file is read as.
struct VideoFiles {
  std::string spec{};       // for messages
  std::string left, right;  // an empty right: left is side by side, its left half is the left camera
  bool loop = false;
  std::optional<StereoCalibration> calibration;  // a resolution of 0 is filled in
};

/// Pairs from two videos, or from one with both pictures side by side. Times are those of the (left) file's
/// frames, from 0. Where one video ends before the other, the rest is counted as skipped. Throws
/// std::runtime_error naming a file that is missing, unreadable or of another size.
[[nodiscard]] std::unique_ptr<StereoSource> open_video(VideoFiles files);

}  // namespace flogmap
