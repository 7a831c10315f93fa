#pragma once

#include <string>
#include <utility>

#include "server/session_control.hpp"

namespace flogmap {

/// Stands in for a session where nothing is mapped, as where only a stored map is served: there is nothing to
/// steer.
class StoredControl final : public SessionControl {
 public:
  explicit StoredControl(std::string file, std::string why = "a stored map is served; nothing runs")
      : file_(std::move(file)), why_(std::move(why)) {}
  [[nodiscard]] SessionState state() const override { return SessionState::stored; }
  [[nodiscard]] std::string reason() const override { return {}; }
  [[nodiscard]] bool live() const override { return false; }
  [[nodiscard]] std::string source() const override { return file_; }
  [[nodiscard]] PlaybackState playback() const override { return {}; }
  ControlResult pause() override { return refuse(); }
  ControlResult resume() override { return refuse(); }
  ControlResult reset() override { return refuse(); }
  ControlResult change_playback(const PlaybackChange& /*change*/) override { return refuse(); }
  ControlResult step() override { return refuse(); }
  [[nodiscard]] LevelState levelling() const override { return {{}, why_}; }
  ControlResult level(const HandLevel& /*level*/) override { return refuse(); }

 private:
  [[nodiscard]] ControlResult refuse() const { return {ControlOutcome::illegal, why_}; }
  const std::string file_, why_;
};

}  // namespace flogmap
