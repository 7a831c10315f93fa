// The pipeline's capture thread: from the source and its control to the queue of frames.
#include <utility>

#include "server/pipeline.hpp"
#include "server/random_epoch.hpp"
#include "server/source_warnings.hpp"

namespace flogmap {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

void Pipeline::capture() {
  source_->on_trouble([this] {
    note_losses();
    tell_counts();
  });
  const std::string epoch = options_.continued.epoch;
  generation_ = {1, epoch.empty() ? random_epoch() : epoch, epoch.empty() ? "started" : "continued",
                 options_.continued.level};
  frames_.push({.generation = generation_, .frame = {}, .at = Clock::now()});
  control_.started();
  for (bool more = true; more;) {
    const CaptureTurn turn = control_.await_turn();
    switch (turn.kind) {
      case CaptureTurn::Kind::stop:
        more = false;
        break;
      case CaptureTurn::Kind::reset:
        restart("reset by operator", 0);
        break;
      case CaptureTurn::Kind::seek:
        go_to(turn.position_s);
        break;
      case CaptureTurn::Kind::level:
        tell_level();
        break;
      case CaptureTurn::Kind::tell:
        tell_counts();
        break;
      case CaptureTurn::Kind::read:
        if (!read_frame()) {
          at_end();
          more = !options_.end_with_source;
        }
        break;
    }
  }
  frames_.close();
}

/// Behind the frames that are under way.
void Pipeline::tell_counts() {
  frames_.push({.generation = generation_, .frame = {}, .tell = true, .at = Clock::now()});
}

void Pipeline::tell_level() {
  frames_.push(
      {.generation = generation_, .frame = {}, .level = control_.levelling().level, .at = Clock::now()});
}

bool Pipeline::read_frame() {
  if (options_.max_frames > 0 && frames_read_ >= options_.max_frames) return false;
  const auto start = Clock::now();
  std::optional<StereoFrame> frame = source_->next();
  note_losses();
  if (!frame) return false;
  ++frames_read_;
  statistics_.add(Stage::read, ms_since(start));
  const std::int64_t timestamp_ns = frame->timestamp_ns;
  control_.await_due(timestamp_ns);
  frames_.push({.generation = generation_, .frame = std::move(frame), .at = Clock::now()});
  control_.frame_delivered(timestamp_ns);
  return true;
}

void Pipeline::note_losses() {
  const std::scoped_lock lock(counters_mutex_);
  const SkippedFrames skipped = source_->skipped();
  counters_.skipped_frames = static_cast<std::uint64_t>(skipped.count);
  counters_.skew = source_->skew();
  source_warnings_ = source_warnings(skipped, assumed_);
}

void Pipeline::at_end() {
  const bool again = control_.loop() && control_.state() != SessionState::draining;
  if (!again) control_.source_ended(generation_.number);
  frames_.push({.generation = generation_, .frame = {}, .ended = true, .at = Clock::now()});
  if (again) restart("the recording starts again", 0);
}

/// Another map from this position of the recording; a live source goes on where it is.
void Pipeline::restart(const std::string& reason, double position_s) {
  const SourceInfo info = source_->info();
  if (!info.live && !info.endless) {
    source_->seek(info.first_timestamp_ns + static_cast<std::int64_t>(position_s * 1e9));
  }
  frames_read_ = 0;
  generation_ = {generation_.number + 1, random_epoch(), reason, control_.level_of_next_map()};
  frames_.push({.generation = generation_, .frame = {}, .at = Clock::now()});
}

/// Forwards, every frame in between is mapped, only faster, so that the map has no hole and the path no jump;
/// backwards, a new map begins.
void Pipeline::go_to(double position_s) {
  const double now_s = control_.playback().position_s;
  if (position_s < now_s) {
    restart("the recording was wound back", position_s);
  } else {
    control_.hurry_until(source_->info().first_timestamp_ns + static_cast<std::int64_t>(position_s * 1e9));
  }
}

}  // namespace flogmap
