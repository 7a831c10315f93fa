#include "camera/mcap/stamped_pairs.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace flogmap::mcap {
namespace {

// Threads of a recorder write pictures a place or two away from their order.
constexpr std::size_t kSettled = 4;
// Of pictures that wait: seconds of any camera, for recorders that write chunks of one camera each.
constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20U;

/// Of times that may be anything.
std::uint64_t distance_ns(std::int64_t a, std::int64_t b) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b)),
             high = static_cast<std::uint64_t>(std::max(a, b));
  return high - low;
}

}  // namespace

void StampedPairs::add(Side side, StampedMessage message) {
  const auto& taken_ns = taken_ns_[side == Side::left ? 0 : 1];
  if (taken_ns && message.stamp_ns <= *taken_ns)
    return skip_(side, message.stamp_ns, "recorded long after newer ones");
  Queue& queue = this->queue(side);
  const auto after = std::upper_bound(
      queue.begin(), queue.end(), message.stamp_ns,
      [](std::int64_t stamp_ns, const StampedMessage& waiting) { return stamp_ns < waiting.stamp_ns; });
  if (after != queue.begin() && std::prev(after)->stamp_ns == message.stamp_ns)
    return skip_(side, message.stamp_ns, "a second picture of that time");
  num_bytes_ += message.bytes.size();
  queue.insert(after, std::move(message));
  // Where a camera has stopped, the other's pictures would pile up.
  const Side other = side == Side::left ? Side::right : Side::left;
  while (num_bytes_ > kMostBytes && this->queue(other).empty() && queue.size() > 1)
    drop_oldest(side, "no partner");
}

bool StampedPairs::wants_more(std::uint64_t next_log_time_ns) const {
  const Queue &left = queues_[0], &right = queues_[1];
  if (left.empty() || right.empty()) return true;
  if (num_bytes_ > kMostBytes) return false;
  if (left.size() < kSettled || right.size() < kSettled) return true;
  return next_log_time_ns <= std::max(left.front().log_time_ns, right.front().log_time_ns);
}

std::optional<StampedPair> StampedPairs::take() {
  const Queue &left = queues_[0], &right = queues_[1];
  if (left.empty() || right.empty()) {
    if (!left.empty()) drop_oldest(Side::left, "no right picture of that time");
    if (!right.empty()) drop_oldest(Side::right, "no left picture of that time");
    return std::nullopt;
  }
  const std::int64_t left_ns = left.front().stamp_ns, right_ns = right.front().stamp_ns;
  const std::uint64_t skew_ns = distance_ns(left_ns, right_ns);
  const auto nearer = [skew_ns](const Queue& queue, std::int64_t to_ns) {
    return queue.size() > 1 && distance_ns(queue[1].stamp_ns, to_ns) < skew_ns;
  };
  const bool apart = skew_ns > static_cast<std::uint64_t>(tolerance_ns_);
  if (left_ns < right_ns && (apart || nearer(left, right_ns))) {
    drop_oldest(Side::left, "no right picture of that time");
  } else if (right_ns < left_ns && (apart || nearer(right, left_ns))) {
    drop_oldest(Side::right, "no left picture of that time");
  } else {
    StampedMessage first = take_oldest(Side::left);
    return StampedPair{std::move(first), take_oldest(Side::right)};
  }
  return std::nullopt;
}

void StampedPairs::clear() {
  queues_ = {};
  num_bytes_ = 0;
  taken_ns_ = {};
}

StampedMessage StampedPairs::take_oldest(Side side) {
  StampedMessage message = std::move(queue(side).front());
  queue(side).pop_front();
  num_bytes_ -= message.bytes.size();
  taken_ns_[side == Side::left ? 0 : 1] = message.stamp_ns;
  return message;
}

void StampedPairs::drop_oldest(Side side, const std::string& reason) {
  skip_(side, take_oldest(side).stamp_ns, reason);
}

}  // namespace flogmap::mcap
