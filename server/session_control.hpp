#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mapping/hand_level.hpp"

namespace flogmap {

enum class SessionState : std::uint8_t {
  starting,  // source and calibration are being opened
  running,
  paused,
  finished,  // a recording has ended; its map is still served
  failed,    // the source broke; `reason` says how, the map is still served
  stored,    // no source: a stored map is served
  draining,  // shutting down
};

/// Replay of a recording; all zero for live sources.
struct PlaybackState {
  bool seekable = false;
  double position_s = 0;  // from the first frame
  double duration_s = 0;
  double rate = 1;  // 1 = as recorded, 0 = as fast as possible
  bool paused = false;
  bool loop = false;
};

/// What became of a command.
enum class ControlOutcome : std::uint8_t {
  done,
  illegal,  // not in this state, or not with a live source: 409
};

struct ControlResult {
  ControlOutcome outcome = ControlOutcome::done;
  std::string detail;  // in words if illegal: "already paused"
};

/// A change of the replay; what is absent stays as it is.
struct PlaybackChange {
  std::optional<double> position_s;
  std::optional<double> rate;
  std::optional<bool> paused;
};

/// How the map was turned and raised by hand, and whether it can be now.
struct LevelState {
  HandLevel level;
  std::string obstacle;  // in words: why not; empty if it can be
};

/// How the network side steers what makes the map. Every call returns at once and may come from any thread:
/// commands go to the capture thread through a one-slot mailbox.
class SessionControl {
 public:
  virtual ~SessionControl() = default;
  [[nodiscard]] virtual SessionState state() const = 0;
  [[nodiscard]] virtual std::string reason() const = 0;  // why failed; empty otherwise
  [[nodiscard]] virtual bool live() const = 0;           // source is a camera
  [[nodiscard]] virtual std::string source() const = 0;  // its spec
  [[nodiscard]] virtual PlaybackState playback() const = 0;
  virtual ControlResult pause() = 0;
  virtual ControlResult resume() = 0;
  virtual ControlResult reset() = 0;
  virtual ControlResult change_playback(const PlaybackChange& change) = 0;
  virtual ControlResult step() = 0;  // one frame, while paused
  [[nodiscard]] virtual LevelState levelling() const = 0;
  /// Levels the map like this instead of as before. The path follows at once, the map when it has been built
  /// anew from the views that it was made of.
  virtual ControlResult level(const HandLevel& level) = 0;
};

}  // namespace flogmap
