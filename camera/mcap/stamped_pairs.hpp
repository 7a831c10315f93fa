#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "camera/frame_pairing.hpp"
#include "camera/mcap/message_kind.hpp"
#include "camera/pair_skew.hpp"

namespace flogmap::mcap {

/// A picture still packed, when it was taken, and when it was recorded.
struct StampedMessage {
  std::int64_t stamp_ns = 0;
  std::uint64_t log_time_ns = 0;
  MessageKind kind;
  std::vector<std::uint8_t> bytes;
};

struct StampedPair {
  StampedMessage left, right;
};

/// Puts messages of two cameras, which come roughly in order, into the order of their stamps and into pairs:
/// the nearest within the tolerance. Holds a few of each side, more only while one side lags behind.
class StampedPairs {
 public:
  /// Called for every message that finds no partner, with its stamp and the reason.
  using Skip = std::function<void(Side, std::int64_t stamp_ns, const std::string& reason)>;

  StampedPairs(std::int64_t tolerance_ns, Skip skip) : tolerance_ns_(tolerance_ns), skip_(std::move(skip)) {}

  void add(Side side, StampedMessage message);

  /// True if what comes next in the file, recorded from `next_log_time_ns` on, should be added before pairs
  /// are taken: always while a side waits for the other.
  [[nodiscard]] bool wants_more(std::uint64_t next_log_time_ns) const;

  /// Takes the oldest pair, or drops what has none; to be called again while this is not empty().
  [[nodiscard]] std::optional<StampedPair> take();

  [[nodiscard]] bool empty() const { return queues_[0].empty() && queues_[1].empty(); }

  /// Forgets all that waits, and that there were pairs before.
  void clear();

 private:
  using Queue = std::deque<StampedMessage>;
  [[nodiscard]] Queue& queue(Side side) { return queues_[side == Side::left ? 0 : 1]; }
  void drop_oldest(Side side, const std::string& reason);
  StampedMessage take_oldest(Side side);

  std::int64_t tolerance_ns_;
  Skip skip_;
  std::array<Queue, 2> queues_;  // by stamp
  std::uint64_t num_bytes_ = 0;
  std::array<std::optional<std::int64_t>, 2> taken_ns_;  // stamp of the newest that has left its queue
};

}  // namespace flogmap::mcap
