#include "mapping/loop/path_correction.hpp"

#include <algorithm>
#include <tuple>

namespace flogmap {
namespace {

/// From a to b, share 0 to 1 of the way.
SE3 between(const SE3& a, const SE3& b, double share) {
  const Eigen::Quaterniond from(a.linear()), to(b.linear());
  SE3 motion = SE3::Identity();
  motion.linear() = from.slerp(share, to).toRotationMatrix();
  motion.translation() = (1 - share) * a.translation() + share * b.translation();
  return motion;
}

}  // namespace

PathCorrection PathCorrection::levelled(const HandLevel& level) const {
  PathCorrection correction(knots_);
  correction.level_ = level;
  correction.map_from_start_ = level.map_from_start();
  return correction;
}

std::optional<SE3> PathCorrection::map_from_odometry(std::int64_t timestamp_ns, int segment) const {
  const std::optional<SE3> placed = start_from_odometry(timestamp_ns, segment);
  if (!placed || level_.is_level()) return placed;
  return map_from_start_ * *placed;
}

std::optional<SE3> PathCorrection::start_from_odometry(std::int64_t timestamp_ns, int segment) const {
  const auto at_or_after =
      std::lower_bound(knots_.begin(), knots_.end(), std::tuple(segment, timestamp_ns),
                       [](const CorrectionKnot& knot, const std::tuple<int, std::int64_t>& wanted) {
                         return std::tuple(knot.segment, knot.timestamp_ns) < wanted;
                       });
  const bool has_next = at_or_after != knots_.end() && at_or_after->segment == segment;
  const bool has_last = at_or_after != knots_.begin() && std::prev(at_or_after)->segment == segment;
  if (!has_next && !has_last) return segment == 0 ? std::optional(SE3::Identity()) : std::nullopt;
  if (!has_last || (has_next && at_or_after->timestamp_ns == timestamp_ns)) {
    return at_or_after->map_from_odometry;
  }
  const CorrectionKnot& last = *std::prev(at_or_after);
  if (!has_next) return last.map_from_odometry;
  const double share = static_cast<double>(timestamp_ns - last.timestamp_ns) /
                       static_cast<double>(at_or_after->timestamp_ns - last.timestamp_ns);
  return between(last.map_from_odometry, at_or_after->map_from_odometry, share);
}

}  // namespace flogmap
