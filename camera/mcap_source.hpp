#pragma once

#include <memory>
#include <optional>
#include <string>

#include "camera/stereo_source.hpp"

namespace flogmap {

/// What an MCAP file is read as.
struct McapRecording {
  std::string spec{};   // for messages
  std::string where{};  // FILE, a folder with one, or FILE,LEFT_TOPIC,RIGHT_TOPIC
  bool loop = false;
  double max_skew_ms = 5;                          // pictures taken further apart are no pair
  std::optional<StereoCalibration> calibration{};  // else the file's, if that is asked for
  bool reads_calibration = true;
};

/// Pairs from two topics of an MCAP file, as ROS 2 and Foxglove record them; times are those of the left
/// pictures' headers. Reads on from chunk to chunk, so files may be of any size. Throws std::runtime_error in
/// one line naming the file, and its topics where it is not clear which are meant.
[[nodiscard]] std::unique_ptr<StereoSource> open_mcap(McapRecording recording);

}  // namespace flogmap
