#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "camera/live/camera_rig.hpp"
#include "camera/stereo_source.hpp"

namespace flogmap {

struct LiveOptions {
  double rate_hz = 20;
  double max_skew_ms = 5;  // pairs taken further apart are dropped, and said so
};

/// Pairs from two live cameras: paired by the times of their sensors, the right camera kept in step with the
/// left one and exposed like it. A camera that is unplugged is waited for.
class LiveSource final : public StereoSource {
 public:
  LiveSource(std::string spec, std::unique_ptr<CameraRig> rig, std::optional<StereoCalibration> calibration,
             const LiveOptions& options);

  std::optional<StereoFrame> next() override;
  void stop() override;
  [[nodiscard]] SourceInfo info() const override;
  [[nodiscard]] std::optional<StereoCalibration> calibration() const override { return calibration_; }
  [[nodiscard]] SkippedFrames skipped() const override;
  [[nodiscard]] std::optional<PairSkew> skew() const override;
  void on_trouble(std::function<void()> tell) override { tell_ = std::move(tell); }

  /// What became of the pictures so far.
  [[nodiscard]] const PairingCounts& counts() const { return pairing_.counts(); }

 private:
  void keep_in_step(const RigPicture& left, std::int64_t skews_before);
  void wait_for_cameras();

  const std::string spec_;
  std::unique_ptr<CameraRig> rig_;
  std::optional<StereoCalibration> calibration_;
  LiveOptions options_;
  FramePairing pairing_;
  FrameServo servo_;
  double exposure_us_ = 0, gain_ = 0;  // what the right camera was last told
  std::int64_t outages_ = 0;
  std::string outage_;  // of the last one
  bool waiting_ = false;
  std::function<void()> tell_;
  std::atomic<bool> stopped_ = false;
};

/// "LEFT_ID,RIGHT_ID": opens both cameras at the calibration's resolution.
struct LiveSpec {
  std::string spec, where;
  std::optional<StereoCalibration> calibration;
  LiveOptions live;
  int width_px = 0, height_px = 0;  // where no calibration says; 0: the rig's own default
  double exposure_us = 0, gain = 0;
};
[[nodiscard]] std::unique_ptr<StereoSource> open_live(LiveSpec spec);

}  // namespace flogmap
