#include "mapping/given_poses.hpp"

#include <cstdlib>

namespace flogmap {
namespace {
constexpr std::int64_t kToleranceNs = 5'000'000;
}

GivenPoses::GivenPoses(const std::map<std::int64_t, SE3>& world_from_frame, const SE3& frame_from_rectified) {
  for (const auto& [timestamp_ns, pose] : world_from_frame) {
    world_from_camera_.emplace(timestamp_ns, pose * frame_from_rectified);
  }
}

std::optional<SE3> GivenPoses::at(std::int64_t timestamp_ns) const {
  auto later = world_from_camera_.lower_bound(timestamp_ns);
  auto nearest = later;
  if (later != world_from_camera_.begin()) {
    const auto earlier = std::prev(later);
    if (later == world_from_camera_.end() || timestamp_ns - earlier->first < later->first - timestamp_ns) {
      nearest = earlier;
    }
  }
  if (nearest == world_from_camera_.end()) return std::nullopt;
  if (std::llabs(nearest->first - timestamp_ns) > kToleranceNs) return std::nullopt;
  return nearest->second;
}

}  // namespace flogmap
