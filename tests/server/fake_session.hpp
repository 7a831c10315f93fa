#pragma once

#include <mutex>
#include <string>
#include <utility>

#include "server/session_control.hpp"

namespace flogmap {

/// A recording of 60 s that can be paused, moved and reset, without any source behind it.
class FakeSession : public SessionControl {
 public:
  [[nodiscard]] SessionState state() const override {
    const std::lock_guard lock(mutex_);
    return playback_.paused ? SessionState::paused : SessionState::running;
  }
  [[nodiscard]] std::string reason() const override { return {}; }
  [[nodiscard]] bool live() const override { return false; }
  [[nodiscard]] std::string source() const override { return "demo:walk"; }
  [[nodiscard]] PlaybackState playback() const override {
    const std::lock_guard lock(mutex_);
    return playback_;
  }
  ControlResult pause() override { return set_paused(true, "already paused"); }
  ControlResult resume() override { return set_paused(false, "not paused"); }
  ControlResult reset() override {
    const std::lock_guard lock(mutex_);
    ++num_resets_;
    return {};
  }
  ControlResult change_playback(const PlaybackChange& change) override {
    const std::lock_guard lock(mutex_);
    if (change.position_s) playback_.position_s = *change.position_s;
    if (change.rate) playback_.rate = *change.rate;
    if (change.paused) playback_.paused = *change.paused;
    return {};
  }
  ControlResult step() override {
    const std::lock_guard lock(mutex_);
    if (!playback_.paused) return {ControlOutcome::illegal, "only while paused"};
    ++num_steps_;
    return {};
  }

  [[nodiscard]] LevelState levelling() const override {
    const std::lock_guard lock(mutex_);
    return {level_, {}};
  }
  ControlResult level(const HandLevel& level) override {
    const std::lock_guard lock(mutex_);
    level_ = level;
    return {};
  }

  void advance(double seconds) {
    const std::lock_guard lock(mutex_);
    playback_.position_s += seconds;
    if (playback_.position_s > playback_.duration_s) playback_.position_s = 0;
  }
  /// How often reset() was asked for since the last call.
  int take_resets() { return take(num_resets_); }
  int take_steps() { return take(num_steps_); }

 private:
  int take(int& count) {
    const std::lock_guard lock(mutex_);
    return std::exchange(count, 0);
  }
  ControlResult set_paused(bool paused, const std::string& complaint) {
    const std::lock_guard lock(mutex_);
    if (playback_.paused == paused) return {ControlOutcome::illegal, complaint};
    playback_.paused = paused;
    return {};
  }

  mutable std::mutex mutex_;
  PlaybackState playback_{
      .seekable = true, .position_s = 0, .duration_s = 60, .rate = 1, .paused = false, .loop = true};
  HandLevel level_;
  int num_resets_ = 0;
  int num_steps_ = 0;
};

}  // namespace flogmap
