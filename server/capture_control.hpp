#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "camera/stereo_source.hpp"
#include "server/session_control.hpp"

namespace flogmap {

/// What the capture thread does next.
struct CaptureTurn {
  enum class Kind : std::uint8_t { read, seek, reset, level, tell, stop };
  Kind kind = Kind::read;
  double position_s = 0;  // of a seek
};

/// The one-slot mailbox between whoever steers (network side, any thread) and the capture thread, and the
/// state machine that both see.
class CaptureControl final : public SessionControl {
 public:
  /// `rate`: 1 as recorded, 0 as fast as possible. Live sources ignore it.
  CaptureControl(const SourceInfo& source, double rate, bool loop);
  /// Before anything runs: the level to begin with, and why the map cannot be levelled now, in words, from
  /// any thread; empty if it can be.
  void begin_level(const HandLevel& level, std::function<std::string()> obstacle);

  // SessionControl, any thread
  [[nodiscard]] SessionState state() const override;
  [[nodiscard]] std::string reason() const override;
  [[nodiscard]] bool live() const override { return source_.live; }
  [[nodiscard]] std::string source() const override { return source_.spec; }
  [[nodiscard]] PlaybackState playback() const override;
  ControlResult pause() override;
  ControlResult resume() override;
  ControlResult reset() override;
  ControlResult change_playback(const PlaybackChange& change) override;
  ControlResult step() override;
  [[nodiscard]] LevelState levelling() const override;
  ControlResult level(const HandLevel& level) override;

  // capture thread
  /// Blocks while paused and once the source has ended; then says what to do.
  CaptureTurn await_turn();
  /// Waits until the frame is due; cut short by a command, a pause or the end.
  void await_due(std::int64_t timestamp_ns);
  void frame_delivered(std::int64_t timestamp_ns);
  /// The source has no more frames of this generation; the session goes on until they are all mapped.
  void source_ended(std::uint64_t generation);
  /// Frames before this time are not paced: a seek forwards plays fast instead of leaving a gap in the map.
  void hurry_until(std::int64_t timestamp_ns);
  [[nodiscard]] bool loop() const { return loop_; }
  /// How the map that begins now is to be levelled: a recording begins as it did before, and is wrong by as
  /// much again; cameras begin elsewhere.
  HandLevel level_of_next_map();

  // the pipeline
  void started();
  /// All of this generation is mapped; nothing if another one has begun meanwhile.
  void finished(std::uint64_t generation);
  void failed(const std::string& reason);
  void drain();

 private:
  using Clock = std::chrono::steady_clock;
  void come_to_rest();
  [[nodiscard]] bool is_on_its_way() const;
  [[nodiscard]] bool reads() const;
  [[nodiscard]] bool has_work() const;
  [[nodiscard]] Clock::time_point due(std::int64_t timestamp_ns);
  ControlResult illegal(const std::string& detail) const { return {ControlOutcome::illegal, detail}; }

  const SourceInfo source_;
  const bool loop_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  SessionState state_ = SessionState::starting;
  std::string reason_;
  bool stop_ = false;
  bool reset_ = false;
  std::optional<double> seek_s_;
  std::optional<std::uint64_t> ended_generation_;  // that nothing can be read of any more
  int steps_ = 0;
  HandLevel level_;
  bool relevel_ = false;
  bool tell_ = false;  // the last counts, since no frame follows
  std::function<std::string()> level_obstacle_;
  double rate_;
  std::int64_t position_ns_ = 0;
  std::int64_t hurry_until_ns_ = 0;
  std::optional<Clock::time_point> anchor_;  // this moment shows the frame of anchor_ns_
  std::int64_t anchor_ns_ = 0;
};

}  // namespace flogmap
