// Two cameras that run by themselves, made into a pair: which pictures belong together, and how to bring the
// cameras into step. Pure: times come in as numbers, so tests need neither cameras nor clocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "camera/image.hpp"
#include "camera/pair_skew.hpp"

namespace flogmap {

enum class Side : std::uint8_t { left, right };

/// A picture and when its sensor took it, by the clock that both cameras share.
struct TimedPicture {
  std::int64_t timestamp_ns = 0;
  Picture picture;
};

struct PairedPictures {
  TimedPicture left, right;
  [[nodiscard]] std::int64_t skew_ns() const { return right.timestamp_ns - left.timestamp_ns; }
};

struct PairingCounts {
  std::int64_t pairs = 0;       // delivered
  std::int64_t too_skewed = 0;  // belonged together but were taken too far apart; dropped
  std::int64_t alone_left = 0;  // had no partner
  std::int64_t alone_right = 0;
  std::int64_t last_too_skewed_ns = 0;  // right - left of the newest of these
  std::int64_t last_skew_ns = 0;        // right - left of the newest pair, dropped or not
  SkewHistogram skew;                   // of all of them
};

/// Pairs pictures as they arrive. Two belong together if they were taken within half a frame period of one
/// another; of these, pairs that are further apart than `max_skew_ns` are dropped and counted. Times of the
/// pairs delivered increase strictly, whatever the cameras do; a camera that starts anew only costs the
/// pictures taken meanwhile. Never holds more than `max_waiting` pictures of a side.
class FramePairing {
 public:
  struct Options {
    std::int64_t period_ns = 50'000'000;
    std::int64_t max_skew_ns = 5'000'000;
    std::size_t max_waiting = 4;
  };
  explicit FramePairing(Options options) : options_(options) {}

  /// Takes a picture; the pair that it completes, if it does.
  [[nodiscard]] std::optional<PairedPictures> offer(Side side, TimedPicture picture);
  [[nodiscard]] const PairingCounts& counts() const { return counts_; }

 private:
  std::deque<TimedPicture>& waiting(Side side) { return waiting_[side == Side::left ? 0 : 1]; }
  void drop_oldest(Side side);
  std::optional<PairedPictures> match();

  Options options_;
  std::array<std::deque<TimedPicture>, 2> waiting_;
  PairingCounts counts_;
  std::optional<std::int64_t> delivered_ns_;  // left time of the newest pair
};

/// Keeps the right camera in step with the left one by its frame duration: a phase-locked loop whose only
/// input is the skew of each pair. Half the frames of a period may be needed per millisecond; a drift of some
/// hundred parts per million leaves no standing error.
class FrameServo {
 public:
  explicit FrameServo(std::int64_t period_ns) : period_ns_(period_ns) {}

  /// The frame duration that the right camera should have from now on, nanoseconds; within 2 % of the period.
  [[nodiscard]] std::int64_t duration_for(std::int64_t skew_ns);

 private:
  std::int64_t period_ns_;
  double drift_ns_ = 0;  // learned: what the right camera's frames must be shorter by to stay in step
};

}  // namespace flogmap
