#include "server/send_window.hpp"

#include <algorithm>
#include <utility>

namespace flogmap {

SendWindow::SendWindow(WireLimits limits)
    : limits_(limits), bytes_(std::min<std::uint64_t>(kLeastBytes, limits.max_unacknowledged_bytes)) {}

void SendWindow::sent(std::size_t bytes, Time now) {
  if (unacknowledged() == 0) owed_since_ = now;
  sent_ += bytes;
  on_the_way_.push_back({sent_, now, acknowledged_});
}

bool SendWindow::acknowledge(std::uint64_t total, Time now) {
  if (total > sent_) return false;
  if (total <= acknowledged_) return true;
  const std::uint64_t was_on_the_way = unacknowledged(), newly = total - acknowledged_;
  acknowledged_ = total;
  owed_since_ = now;
  Message answered{};
  int num_answered = 0;
  for (; !on_the_way_.empty() && on_the_way_.front().end <= total; ++num_answered) {
    answered = on_the_way_.front();
    on_the_way_.pop_front();
  }
  answers_each_ = num_answered <= 1;
  if (num_answered > 0) learn(answered, was_on_the_way, newly, now);
  return true;
}

void SendWindow::learn(const Message& answered, std::uint64_t was_on_the_way, std::uint64_t newly, Time now) {
  const Duration took = now - answered.sent_at;
  if (now - while_began_ > kLately) {
    quickest_before_ = std::exchange(quickest_, kLongestWay);
    while_began_ = now;
  }
  quickest_ = std::min(quickest_, took);
  if (took > way() + kLate) {
    using Seconds = std::chrono::duration<double>;
    const auto taken_in = static_cast<double>(answered.end - answered.acknowledged_then);
    const double aimed = taken_in * (Seconds(way() + kAimed) / Seconds(took));
    const std::uint64_t least = std::min<std::uint64_t>(kLeastBytes, limits_.max_unacknowledged_bytes);
    bytes_ = std::clamp(static_cast<std::uint64_t>(aimed), least, bytes_);
  } else if (took < way() + kQuick && 2 * was_on_the_way >= bytes_) {
    bytes_ = std::min<std::uint64_t>(limits_.max_unacknowledged_bytes, bytes_ + newly);
  }
}

SendWindow::Duration SendWindow::way() const { return std::min(quickest_, quickest_before_); }

std::size_t SendWindow::batch_bytes() const {
  return static_cast<std::size_t>(
      std::min<std::uint64_t>(limits_.max_batch_bytes, bytes_ / kBatchesOnTheWay));
}

std::optional<SendWindow::Time> SendWindow::opens_at(Time now) const {
  if (unacknowledged() == 0 || answers_each_ || silent(now) || bytes_ >= limits_.max_unacknowledged_bytes)
    return std::nullopt;
  return owed_since_ + kSilent;
}

bool SendWindow::behind(Time now) const {
  if (on_the_way_.empty() || silent(now)) return false;
  return now - on_the_way_.front().sent_at > way() + kQuick;
}

bool SendWindow::overdue(Time now) const { return unacknowledged() > 0 && now - owed_since_ >= kAckDeadline; }

}  // namespace flogmap
