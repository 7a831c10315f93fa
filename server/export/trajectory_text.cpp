#include "server/export/trajectory_text.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>

namespace flogmap {
namespace {

bool has_pose(const TrajectoryEntry& entry) {
  return entry.state == TrackingState::ok || entry.state == TrackingState::weak;
}

std::string number(double value, const char* format) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

/// Seconds with all nine places, which a double has not got for times since 1970.
std::string seconds(std::int64_t timestamp_ns) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%s%lld.%09lld", timestamp_ns < 0 ? "-" : "",
                std::llabs(timestamp_ns / kNsPerS), std::llabs(timestamp_ns % kNsPerS));
  return text.data();
}

}  // namespace

std::string tum_of(std::span<const TrajectoryEntry> trajectory) {
  std::string text;
  for (const TrajectoryEntry& entry : trajectory) {
    if (!has_pose(entry)) continue;
    const Eigen::Vector3d p = entry.world_from_camera.translation();
    const Eigen::Quaterniond q(entry.world_from_camera.linear());
    text += seconds(entry.timestamp_ns);
    for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()})
      text += number(value, " %.9f");
    text += '\n';
  }
  return text;
}

std::string kitti_of(std::span<const TrajectoryEntry> trajectory) {
  std::string text;
  for (const TrajectoryEntry& entry : trajectory) {
    if (!has_pose(entry)) continue;
    for (int i = 0; i < 12; ++i) {
      if (i > 0) text += ' ';
      text += number(entry.world_from_camera(i / 4, i % 4), "%.9e");
    }
    text += '\n';
  }
  return text;
}

}  // namespace flogmap
