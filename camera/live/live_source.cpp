#include "camera/live/live_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace flogmap {
namespace {

constexpr double kNsPerS = 1e9, kNsPerMs = 1e6;
constexpr std::chrono::milliseconds kLookAgain{500};

std::int64_t period_ns(double rate_hz) { return std::llround(kNsPerS / rate_hz); }

}  // namespace

LiveSource::LiveSource(std::string spec, std::unique_ptr<CameraRig> rig,
                       std::optional<StereoCalibration> calibration, const LiveOptions& options)
    : spec_(std::move(spec)),
      rig_(std::move(rig)),
      calibration_(std::move(calibration)),
      options_(options),
      pairing_({.period_ns = period_ns(options.rate_hz),
                .max_skew_ns = std::llround(options.max_skew_ms * kNsPerMs),
                .max_waiting = 4}),
      servo_(period_ns(options.rate_hz)) {}

std::optional<StereoFrame> LiveSource::next() {
  while (!stopped_) {
    std::optional<RigPicture> taken = rig_->wait(kLookAgain);
    if (!taken) {
      if (!stopped_ && !rig_->lost().empty()) wait_for_cameras();
      continue;
    }
    const std::int64_t skews_before = pairing_.counts().skew.total();
    const Side side = taken->side;
    const RigPicture exposed{side, {}, taken->exposure_us, taken->gain};
    auto pair = pairing_.offer(side, std::move(taken->picture));
    keep_in_step(exposed, skews_before);
    if (!pair) continue;
    return StereoFrame{pair->left.timestamp_ns, std::move(pair->left.picture), std::move(pair->right.picture),
                       CaptureDetails{pair->skew_ns(), exposure_us_, gain_}};
  }
  return std::nullopt;
}

/// Frame durations by the skew of each new pair, delivered or not; exposure by the left camera's.
void LiveSource::keep_in_step(const RigPicture& taken, std::int64_t skews_before) {
  const PairingCounts& counts = pairing_.counts();
  if (counts.skew.total() > skews_before && !rig_->keeps_step())
    rig_->set_right_duration(servo_.duration_for(counts.last_skew_ns));
  const bool known = taken.side == Side::left && taken.exposure_us > 0 && taken.gain > 0;
  if (!known || (taken.exposure_us == exposure_us_ && taken.gain == gain_)) return;
  exposure_us_ = taken.exposure_us;
  gain_ = taken.gain;
  rig_->set_right_exposure(exposure_us_, gain_);
}

void LiveSource::wait_for_cameras() {
  outage_ = rig_->lost();
  ++outages_;
  waiting_ = true;
  if (tell_) tell_();
  while (!stopped_ && !rig_->reopen()) (void)rig_->wait(kLookAgain);
  waiting_ = false;
  if (tell_) tell_();
  exposure_us_ = gain_ = 0;  // a camera that comes back has forgotten
}

void LiveSource::stop() {
  stopped_ = true;
  rig_->stop();
}

SourceInfo LiveSource::info() const {
  return {.spec = spec_,
          .live = true,
          .endless = true,
          .num_frames = std::nullopt,
          .first_timestamp_ns = 0,
          .last_timestamp_ns = 0};
}

SkippedFrames LiveSource::skipped() const {
  const PairingCounts& counts = pairing_.counts();
  SkippedFrames skipped;
  skipped.count = counts.too_skewed + std::max(counts.alone_left, counts.alone_right);
  char text[160] = "";
  if (counts.too_skewed > 0) {
    std::snprintf(text, sizeof text,
                  "left and right were taken %.1f ms apart, allowed are %.1f ms (--max-skew-ms)",
                  std::abs(static_cast<double>(counts.last_too_skewed_ns)) / kNsPerMs, options_.max_skew_ms);
  } else if (skipped.count > 0) {
    std::snprintf(text, sizeof text, "%lld left and %lld right pictures had no partner",
                  static_cast<long long>(counts.alone_left), static_cast<long long>(counts.alone_right));
  }
  skipped.last_reason = text;
  if (outages_ > 0) {
    skipped.last_reason += (skipped.last_reason.empty() ? "" : "; ") + outage_ +
                           (waiting_ ? "; waiting until it is back" : "; it came back");
  }
  return skipped;
}

std::optional<PairSkew> LiveSource::skew() const {
  const PairingCounts& counts = pairing_.counts();
  return PairSkew{counts.skew, options_.max_skew_ms, counts.too_skewed};
}

std::unique_ptr<StereoSource> open_live(LiveSpec live) {
  const std::size_t comma = live.where.find(',');
  if (comma == std::string::npos || comma == 0 || comma + 1 == live.where.size())
    throw std::runtime_error("libcamera: must be LEFT_ID,RIGHT_ID, got '" + live.where +
                             "'; flogmap cameras lists the ids");
  RigOptions rig{.left_id = live.where.substr(0, comma), .right_id = live.where.substr(comma + 1)};
  if (rig.left_id == rig.right_id)
    throw std::runtime_error("libcamera: left and right must be two cameras, got '" + rig.left_id +
                             "' twice");
  if (!live.calibration && live.width_px > 0) {
    rig.width_px = live.width_px;
    rig.height_px = live.height_px;
  }
  if (live.calibration) {
    rig.width_px = live.calibration->left.width_px;
    rig.height_px = live.calibration->left.height_px;
  }
  rig.rate_hz = live.live.rate_hz;
  rig.exposure_us = live.exposure_us;
  rig.gain = live.gain;
  return std::make_unique<LiveSource>(live.spec, open_libcamera_rig(rig), std::move(live.calibration),
                                      live.live);
}

}  // namespace flogmap
