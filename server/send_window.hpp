// How much may be on the way to one client. No sockets, no clock: the time is told.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "server/wire.hpp"

namespace flogmap {

/// Learns from the acknowledgements how much a line and its page take in about a second, and lets little more
/// be under way: what is sent after it would wait that long. It starts small, grows with every quick answer
/// while it is made use of, and when answers are late it becomes what was taken in lately in about a second.
/// So a slow page soon hears something, a pose is never far behind, and no message keeps a line so long that
/// it is taken for dead.
class SendWindow {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  static constexpr std::uint64_t kLeastBytes = 64U << 10U;  // and to begin with
  static constexpr std::uint64_t kBatchesOnTheWay = 4;
  // Beyond the quickest answer lately, which is the way there and back and what a busy page needs anyhow.
  static constexpr std::chrono::milliseconds kQuick{300};
  static constexpr std::chrono::milliseconds kAimed{500};
  static constexpr std::chrono::milliseconds kLate{900};
  static constexpr std::chrono::milliseconds kLongestWay{1200};  // what takes longer waits in a queue of ours
  static constexpr std::chrono::seconds kLately{5};              // to twice that
  // A client that acknowledges several messages at once and says nothing for so long may wait for more of
  // them: then the limits alone count.
  static constexpr std::chrono::seconds kSilent{2};
  static constexpr std::chrono::seconds kAckDeadline{30};

  explicit SendWindow(WireLimits limits);

  void sent(std::size_t bytes, Time now);
  /// `total`: of all bytes since the connection began. False if that is more than was sent.
  bool acknowledge(std::uint64_t total, Time now);

  [[nodiscard]] std::uint64_t unacknowledged() const { return sent_ - acknowledged_; }
  [[nodiscard]] std::uint64_t bytes(Time now) const {
    return silent(now) ? limits_.max_unacknowledged_bytes : bytes_;
  }
  /// The size that a message may have: one of about four on the way.
  [[nodiscard]] std::size_t batch_bytes() const;
  /// One more of that size may be sent.
  [[nodiscard]] bool open(Time now) const { return unacknowledged() + batch_bytes() <= bytes(now); }
  /// When more may be sent though nothing is acknowledged until then; nothing if that would change nothing.
  [[nodiscard]] std::optional<Time> opens_at(Time now) const;
  /// An answer is late, and they do come: what can wait had better wait.
  [[nodiscard]] bool behind(Time now) const;
  /// Nothing acknowledged for 30 s, though something is owed.
  [[nodiscard]] bool overdue(Time now) const;
  [[nodiscard]] std::size_t memory_bytes() const { return on_the_way_.size() * sizeof(Message); }

 private:
  struct Message {
    std::uint64_t end;  // sum of all bytes up to its last
    Time sent_at;
    std::uint64_t acknowledged_then;
  };

  [[nodiscard]] bool silent(Time now) const {
    return !answers_each_ && unacknowledged() > 0 && now - owed_since_ >= kSilent;
  }
  /// The quickest answer lately, at most kLongestWay.
  [[nodiscard]] Duration way() const;
  void learn(const Message& answered, std::uint64_t was_on_the_way, std::uint64_t newly, Time now);

  WireLimits limits_;
  std::uint64_t bytes_;
  std::uint64_t sent_ = 0;
  std::uint64_t acknowledged_ = 0;
  std::deque<Message> on_the_way_;   // oldest first
  bool answers_each_ = false;        // the last Ack was of one message
  Duration quickest_ = kLongestWay;  // of this while
  Duration quickest_before_ = kLongestWay;
  Time while_began_{};
  Time owed_since_{};
};

}  // namespace flogmap
