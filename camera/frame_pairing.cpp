#include "camera/frame_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace flogmap {

void FramePairing::drop_oldest(Side side) {
  waiting(side).pop_front();
  ++(side == Side::left ? counts_.alone_left : counts_.alone_right);
}

std::optional<PairedPictures> FramePairing::offer(Side side, TimedPicture picture) {
  std::deque<TimedPicture>& queue = waiting(side);
  // A camera that steps back in time has started anew: what it took before will find no partner any more.
  while (!queue.empty() && picture.timestamp_ns <= queue.back().timestamp_ns) drop_oldest(side);
  queue.push_back(std::move(picture));
  if (queue.size() > options_.max_waiting) drop_oldest(side);
  return match();
}

/// Pairs the oldest of both sides; of two that do not belong together the older one has missed its partner.
std::optional<PairedPictures> FramePairing::match() {
  std::deque<TimedPicture>& left = waiting(Side::left);
  std::deque<TimedPicture>& right = waiting(Side::right);
  while (!left.empty() && !right.empty()) {
    const std::int64_t skew_ns = right.front().timestamp_ns - left.front().timestamp_ns;
    if (2 * std::abs(skew_ns) > options_.period_ns) {
      drop_oldest(skew_ns > 0 ? Side::left : Side::right);
      continue;
    }
    PairedPictures pair{std::move(left.front()), std::move(right.front())};
    left.pop_front();
    right.pop_front();
    counts_.last_skew_ns = skew_ns;
    counts_.skew.add(skew_ns);
    const bool in_order = !delivered_ns_ || pair.left.timestamp_ns > *delivered_ns_;
    if (std::abs(skew_ns) > options_.max_skew_ns || !in_order) {
      ++counts_.too_skewed;
      counts_.last_too_skewed_ns = skew_ns;
      continue;
    }
    delivered_ns_ = pair.left.timestamp_ns;
    ++counts_.pairs;
    return pair;
  }
  return std::nullopt;
}

std::int64_t FrameServo::duration_for(std::int64_t skew_ns) {
  // The skew is the sum of all differences of duration so far: a proportional and an integral term make a
  // loop that is well damped even if a new duration takes effect some frames late.
  constexpr double kProportional = 0.08, kIntegral = 0.002, kLargestShare = 0.02;
  const double limit_ns = kLargestShare * static_cast<double>(period_ns_);
  const auto skew = static_cast<double>(skew_ns);
  const double wanted_ns = kProportional * skew + drift_ns_;
  if (std::abs(wanted_ns) < limit_ns) drift_ns_ += kIntegral * skew;  // no winding up while at the limit
  return period_ns_ - std::llround(std::clamp(wanted_ns, -limit_ns, limit_ns));
}

}  // namespace flogmap
