#include "server/capture_control.hpp"

#include <algorithm>
#include <utility>

namespace flogmap {
namespace {
constexpr double kNsPerSecond = 1e9;
// Further behind than this, the replay starts counting anew instead of racing to catch up.
constexpr std::chrono::milliseconds kMaxLag{500};
}  // namespace

CaptureControl::CaptureControl(const SourceInfo& source, double rate, bool loop)
    : source_(source), loop_(loop), rate_(rate), position_ns_(source.first_timestamp_ns) {}

SessionState CaptureControl::state() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

std::string CaptureControl::reason() const {
  const std::scoped_lock lock(mutex_);
  return reason_;
}

PlaybackState CaptureControl::playback() const {
  const std::scoped_lock lock(mutex_);
  PlaybackState playback;
  playback.paused = state_ == SessionState::paused;
  if (source_.live) return playback;
  playback.rate = rate_;
  playback.position_s = static_cast<double>(position_ns_ - source_.first_timestamp_ns) / kNsPerSecond;
  if (source_.endless || !source_.num_frames) return playback;
  playback.seekable = true;
  playback.duration_s =
      static_cast<double>(source_.last_timestamp_ns - source_.first_timestamp_ns) / kNsPerSecond;
  playback.loop = loop_;
  return playback;
}

ControlResult CaptureControl::pause() {
  const std::scoped_lock lock(mutex_);
  if (state_ == SessionState::paused) return illegal("already paused");
  if (state_ != SessionState::running) return illegal("only a running session can be paused");
  come_to_rest();
  changed_.notify_all();
  return {};
}

/// Also from a seek that is still on its way.
void CaptureControl::come_to_rest() {
  state_ = SessionState::paused;
  hurry_until_ns_ = 0;
  tell_ = true;
}

/// Paused, but sought forwards: the frames up to there are read, then it rests again.
bool CaptureControl::is_on_its_way() const {
  return state_ == SessionState::paused && position_ns_ < hurry_until_ns_;
}

ControlResult CaptureControl::resume() {
  const std::scoped_lock lock(mutex_);
  if (state_ != SessionState::paused) return illegal("only a paused session can be resumed");
  state_ = SessionState::running;
  steps_ = 0;
  anchor_.reset();
  changed_.notify_all();
  return {};
}

ControlResult CaptureControl::reset() {
  const std::scoped_lock lock(mutex_);
  if (state_ != SessionState::running && state_ != SessionState::paused && state_ != SessionState::finished) {
    return illegal("there is no running session to reset");
  }
  reset_ = true;
  changed_.notify_all();
  return {};
}

ControlResult CaptureControl::change_playback(const PlaybackChange& change) {
  if (source_.live) return illegal("a live source cannot be replayed");
  if (change.position_s && (source_.endless || !source_.num_frames)) {
    return illegal("this source cannot seek");
  }
  const std::scoped_lock lock(mutex_);
  if (state_ != SessionState::running && state_ != SessionState::paused && state_ != SessionState::finished) {
    return illegal("there is no replay to change");
  }
  if (state_ == SessionState::finished && !change.position_s && change.paused) {
    return illegal("the recording has ended; set position_s to play it again");
  }
  if (change.rate) rate_ = *change.rate;
  if (change.position_s) seek_s_ = change.position_s;
  if (change.paused == true) come_to_rest();
  if (change.paused == false) state_ = SessionState::running;
  anchor_.reset();
  changed_.notify_all();
  return {};
}

ControlResult CaptureControl::step() {
  if (source_.live) return illegal("a live source cannot be stepped");
  const std::scoped_lock lock(mutex_);
  if (state_ != SessionState::paused) return illegal("only a paused session can be stepped");
  ++steps_;
  changed_.notify_all();
  return {};
}

void CaptureControl::begin_level(const HandLevel& level, std::function<std::string()> obstacle) {
  level_ = level;
  level_obstacle_ = std::move(obstacle);
}

LevelState CaptureControl::levelling() const {
  const std::scoped_lock lock(mutex_);
  if (state_ != SessionState::running && state_ != SessionState::paused && state_ != SessionState::finished) {
    return {level_, "there is no running session whose map could be levelled"};
  }
  return {level_, level_obstacle_ ? level_obstacle_() : ""};
}

ControlResult CaptureControl::level(const HandLevel& level) {
  const std::string obstacle = levelling().obstacle;
  if (!obstacle.empty()) return illegal(obstacle);
  const std::scoped_lock lock(mutex_);
  level_ = level;
  relevel_ = true;
  changed_.notify_all();
  return {};
}

HandLevel CaptureControl::level_of_next_map() {
  const std::scoped_lock lock(mutex_);
  if (source_.live) level_ = {};
  return level_;
}

bool CaptureControl::reads() const {
  return !ended_generation_ && (state_ == SessionState::running || steps_ > 0 || is_on_its_way());
}

bool CaptureControl::has_work() const { return stop_ || tell_ || relevel_ || reset_ || seek_s_ || reads(); }

CaptureTurn CaptureControl::await_turn() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return has_work(); });
  if (stop_) return {.kind = CaptureTurn::Kind::stop};
  if (reset_ || seek_s_) {
    anchor_.reset();
    hurry_until_ns_ = 0;
    ended_generation_.reset();
    if (state_ == SessionState::finished) state_ = SessionState::running;
    if (reset_) {
      reset_ = false;
      seek_s_.reset();
      return {.kind = CaptureTurn::Kind::reset};
    }
    const double position_s = *std::exchange(seek_s_, std::nullopt);
    if (state_ == SessionState::paused) ++steps_;  // show the frame that was sought
    return {.kind = CaptureTurn::Kind::seek, .position_s = position_s};
  }
  if (std::exchange(relevel_, false)) return {.kind = CaptureTurn::Kind::level};
  if (reads()) {
    if (state_ == SessionState::paused && !is_on_its_way()) --steps_;
    return {};
  }
  tell_ = false;
  return {.kind = CaptureTurn::Kind::tell};
}

CaptureControl::Clock::time_point CaptureControl::due(std::int64_t timestamp_ns) {
  const auto now = Clock::now();
  if (rate_ <= 0 || timestamp_ns < hurry_until_ns_ || state_ != SessionState::running) {
    anchor_.reset();
    return now;
  }
  if (anchor_) {
    const double wait_s = static_cast<double>(timestamp_ns - anchor_ns_) / kNsPerSecond / rate_;
    const auto at =
        *anchor_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait_s));
    if (at > now - kMaxLag) return at;
  }
  anchor_ = now;
  anchor_ns_ = timestamp_ns;
  return now;
}

void CaptureControl::await_due(std::int64_t timestamp_ns) {
  std::unique_lock lock(mutex_);
  if (source_.live) return;
  const auto at = due(timestamp_ns);
  changed_.wait_until(lock, at, [&] { return stop_ || reset_ || seek_s_ || !anchor_; });
}

void CaptureControl::frame_delivered(std::int64_t timestamp_ns) {
  const std::scoped_lock lock(mutex_);
  position_ns_ = timestamp_ns;
  if (state_ == SessionState::paused && !is_on_its_way()) tell_ = true;
}

void CaptureControl::hurry_until(std::int64_t timestamp_ns) {
  const std::scoped_lock lock(mutex_);
  hurry_until_ns_ = timestamp_ns;
  steps_ = 0;
}

void CaptureControl::source_ended(std::uint64_t generation) {
  const std::scoped_lock lock(mutex_);
  ended_generation_ = generation;
  steps_ = 0;
}

void CaptureControl::finished(std::uint64_t generation) {
  const std::scoped_lock lock(mutex_);
  if (ended_generation_ != generation) return;
  if (state_ == SessionState::running || state_ == SessionState::paused) state_ = SessionState::finished;
}

void CaptureControl::started() {
  const std::scoped_lock lock(mutex_);
  if (state_ == SessionState::starting) state_ = SessionState::running;
}

void CaptureControl::failed(const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  if (state_ == SessionState::draining) return;
  state_ = SessionState::failed;
  reason_ = reason;
}

void CaptureControl::drain() {
  const std::scoped_lock lock(mutex_);
  stop_ = true;
  if (state_ != SessionState::failed) state_ = SessionState::draining;
  changed_.notify_all();
}

}  // namespace flogmap
