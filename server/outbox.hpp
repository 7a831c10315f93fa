// What one client still needs, and in which order. No sockets, no clock: the time is told.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/client_message.hpp"
#include "server/send_window.hpp"
#include "server/served_map.hpp"
#include "server/wire.hpp"

namespace flogmap {

/// State of one connection to a map. It never holds a message for later that could be made anew: tiles wait
/// as numbers, at most one each; poses, pictures and reports wait in one slot each, the newest replacing the
/// older. So a slow client gets fewer and newer values, never gaps.
class Outbox {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMaxControls = 64;
  static constexpr std::chrono::milliseconds kChangeInterval{100};  // changes at no more than 10 Hz
  static constexpr std::chrono::milliseconds kTrajectoryInterval{200};
  static constexpr std::size_t kTrajectoryPart = 1024;  // entries in one message, at most
  static constexpr int kPosesSkippedBehind = 3;         // of four, while answers are late

  explicit Outbox(WireLimits limits = {}) : window_(limits) {}

  // What the client says.
  void resume(const Resume& known, const ServedMap& map);
  void subscribe(const Subscribe& wish, const ServedMap& map);
  void look_at(const Viewport& viewport, const ServedMap& map);
  void forget(const std::vector<TileKey>& keys, const ServedMap& map);
  /// False if it acknowledges more than it was sent.
  bool acknowledge(std::uint64_t bytes, Time now);

  // What happens.
  void changed(std::span<const Slot> slots);
  void rewritten(std::string reason);  // the trajectory
  void reset(const ServedMap& map);    // another map begins; call control(encode_reset()) before
  /// False if too many wait: the client does not read, close it.
  bool control(Bytes message);
  void pose(Bytes message) { pose_ = std::move(message); }
  void features(Bytes message) { features_ = std::move(message); }
  void status(Bytes message) { status_ = std::move(message); }
  void playback(Bytes message) { playback_ = std::move(message); }
  void image(ImageStream stream, Bytes message) { images_[static_cast<int>(stream)] = std::move(message); }

  /// The message to send now; nothing if there is none, or none that may be sent yet.
  Bytes next(ServedMap& map, Time now);

  /// When next() may have something that it withholds now because of a rate.
  [[nodiscard]] std::optional<Time> next_at(const ServedMap& map, Time now) const;

  /// It has owed an Ack for 30 s.
  [[nodiscard]] bool overdue(Time now) const { return window_.overdue(now); }

  [[nodiscard]] bool subscribed() const { return subscribed_; }
  [[nodiscard]] bool wants_pose() const { return pose_interval_.has_value(); }
  [[nodiscard]] bool holds_image(ImageStream stream) const {
    return images_[static_cast<int>(stream)] != nullptr;
  }
  [[nodiscard]] std::uint64_t unacknowledged() const { return window_.unacknowledged(); }
  [[nodiscard]] std::size_t num_pending() const { return waiting_.size() + round_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  enum class Need : std::uint8_t { none, waiting, round, forgotten };

  void begin_snapshot(const ServedMap& map);
  void need(Slot slot);
  void begin_round(const ServedMap& map, Time now);
  void sort_round(const ServedMap& map);
  [[nodiscard]] bool visible(const ServedMap& map, Slot slot) const;
  [[nodiscard]] std::size_t trajectory_part() const;
  Bytes next_control();
  Bytes next_pose(Time now);
  Bytes next_trajectory(ServedMap& map, Time now);
  Bytes next_tiles(ServedMap& map, Time now);
  Bytes next_image(Time now);
  [[nodiscard]] bool image_waits() const;
  [[nodiscard]] bool image_first() const;

  SendWindow window_;
  bool subscribed_ = false;
  TileChoice choice_;
  std::optional<Viewport> viewport_;
  std::optional<std::uint64_t> resumed_revision_;  // it has all tiles as of this; nothing: it has none

  std::vector<Need> needs_;     // by slot
  std::vector<Slot> waiting_;   // changed since the round began
  std::vector<Slot> round_;     // being sent, from the back
  std::size_t num_sorted_ = 0;  // of the round's end: the nearest of all, nearest last
  bool in_snapshot_ = false;
  std::uint64_t round_revision_ = 0;  // once the round is done, the client has every tile as of this
  Time next_round_{};
  bool round_done_ = false;  // since the last picture: the next one goes before another round begins

  std::deque<Bytes> controls_;
  Bytes pose_, features_, status_, playback_;
  std::array<Bytes, kNumImageStreams> images_;
  std::optional<std::chrono::nanoseconds> pose_interval_;  // nothing: wants no poses
  Time next_pose_{};

  std::size_t trajectory_sent_ = 0;
  std::optional<std::string> rewrite_reason_;  // the whole trajectory is due
  Time next_trajectory_{};
};

}  // namespace flogmap
