// Where the frame of the odometry lies in the corrected map, at every moment of the path.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/hand_level.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// The correction as it is known at one moment.
struct CorrectionKnot {
  std::int64_t timestamp_ns = 0;
  int segment = 0;  // of the odometry
  SE3 map_from_odometry = SE3::Identity();
};

/// A value: what loops, and whoever levels the map by hand, say of all poses, those of views and of the
/// frames between them alike.
///
/// Between two knots of a segment it is interpolated, before the first and after the last one it is theirs. A
/// segment without a knot has no known place; only the first, number 0, is then where odometry has it.
class PathCorrection {
 public:
  PathCorrection() = default;

  /// Knots in order of segment and time; see LoopCloser.
  explicit PathCorrection(std::vector<CorrectionKnot> knots) : knots_(std::move(knots)) {}

  /// The same, then levelled like this instead of as before.
  [[nodiscard]] PathCorrection levelled(const HandLevel& level) const;

  [[nodiscard]] const HandLevel& level() const { return level_; }

  [[nodiscard]] std::optional<SE3> map_from_odometry(std::int64_t timestamp_ns, int segment) const;

  [[nodiscard]] const std::vector<CorrectionKnot>& knots() const { return knots_; }

 private:
  [[nodiscard]] std::optional<SE3> start_from_odometry(std::int64_t timestamp_ns, int segment) const;

  std::vector<CorrectionKnot> knots_;  // levelled by nobody
  HandLevel level_;
  SE3 map_from_start_ = SE3::Identity();
};

}  // namespace flogmap
