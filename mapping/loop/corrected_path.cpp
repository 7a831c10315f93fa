#include "mapping/loop/corrected_path.hpp"

#include <algorithm>

namespace flogmap {

std::optional<SE3> CorrectedPath::place(std::int64_t timestamp_ns, int segment,
                                        const SE3& world_from_camera) const {
  const std::optional<SE3> map_from_odometry = correction_.map_from_odometry(timestamp_ns, segment);
  if (!map_from_odometry) return std::nullopt;
  return *map_from_odometry * world_from_camera;
}

std::vector<TrajectoryEntry> CorrectedPath::add(const std::vector<TrajectoryEntry>& entries) {
  entries_.insert(entries_.end(), entries.begin(), entries.end());
  std::vector<TrajectoryEntry> placed;
  for (TrajectoryEntry entry : entries) {
    const auto pose = place(entry.timestamp_ns, entry.segment, entry.world_from_camera);
    if (!pose) continue;
    entry.world_from_camera = *pose;
    placed.push_back(entry);
  }
  num_unplaced_ += entries.size() - placed.size();
  return placed;
}

std::vector<TrajectoryEntry> CorrectedPath::corrected() const {
  std::vector<TrajectoryEntry> path = earlier_;
  for (TrajectoryEntry entry : entries_) {
    const auto pose = place(entry.timestamp_ns, entry.segment, entry.world_from_camera);
    if (!pose) continue;
    entry.world_from_camera = *pose;
    path.push_back(entry);
  }
  return path;
}

void CorrectedPath::correct(PathCorrection correction) {
  correction_ = std::move(correction);
  num_unplaced_ = static_cast<std::size_t>(
      std::count_if(entries_.begin(), entries_.end(), [&](const TrajectoryEntry& entry) {
        return !correction_.map_from_odometry(entry.timestamp_ns, entry.segment);
      }));
}

}  // namespace flogmap
