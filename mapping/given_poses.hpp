#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>

#include "mapping/view.hpp"

namespace flogmap {

/// Which frame a given pose is of.
enum class PosesFrame : std::uint8_t {
  rectified,  // the rectified left camera
  raw,        // the left camera before rectification
  body,       // the body of an EuRoC recording
};

/// Poses from outside instead of odometry: world_from_camera of the rectified left camera by time.
class GivenPoses {
 public:
  /// `world_from_frame` by timestamp_ns; `frame_from_rectified` turns them into the rectified left camera's.
  GivenPoses(const std::map<std::int64_t, SE3>& world_from_frame, const SE3& frame_from_rectified);

  /// The pose nearest in time within 5 ms; nothing if there is none.
  [[nodiscard]] std::optional<SE3> at(std::int64_t timestamp_ns) const;

 private:
  std::map<std::int64_t, SE3> world_from_camera_;
};

}  // namespace flogmap
