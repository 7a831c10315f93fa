#pragma once

#include <optional>
#include <string>

#include "camera/calibration/ros_calibration.hpp"
#include "camera/mcap/message_kind.hpp"

namespace flogmap::mcap {

/// A message of the camera_info kind, its numbers unchecked; nothing if it is cut off or no such message.
[[nodiscard]] std::optional<RosCameraInfo> read_camera_info(MessageKind kind, ByteView message,
                                                            std::string origin);

/// False for what drivers send that have no calibration: focal lengths of zero.
[[nodiscard]] bool is_calibrated(const RosCameraInfo& info);

}  // namespace flogmap::mcap
