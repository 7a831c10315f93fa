// The path of all frames: as odometry has it, and where the corrections put it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mapping/loop/path_correction.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// Frames of a segment whose place is unknown are kept, but not shown: they appear when the segment is
/// joined.
class CorrectedPath {
 public:
  /// `earlier`: a path of before, which stays as it is.
  explicit CorrectedPath(std::vector<TrajectoryEntry> earlier = {}) : earlier_(std::move(earlier)) {}

  /// Takes frames in order, poses as odometry has them; returns those whose place is known, corrected.
  std::vector<TrajectoryEntry> add(const std::vector<TrajectoryEntry>& entries);

  void correct(PathCorrection correction);

  /// Everything whose place is known, by the newest correction.
  [[nodiscard]] std::vector<TrajectoryEntry> corrected() const;

  /// A pose of odometry in the corrected map, if its place is known.
  [[nodiscard]] std::optional<SE3> place(std::int64_t timestamp_ns, int segment,
                                         const SE3& world_from_camera) const;

  /// Frames that wait for their segment to be joined.
  [[nodiscard]] std::size_t num_unplaced() const { return num_unplaced_; }

 private:
  std::vector<TrajectoryEntry> earlier_;
  std::vector<TrajectoryEntry> entries_;  // uncorrected
  PathCorrection correction_;
  std::size_t num_unplaced_ = 0;
};

}  // namespace flogmap
