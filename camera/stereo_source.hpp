#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "camera/calibration/stereo_calibration.hpp"
#include "camera/pair_skew.hpp"
#include "camera/stereo_frame.hpp"

namespace flogmap {

/// What is known of a source before its first frame.
struct SourceInfo {
  std::string spec;                        // as given, for instance "euroc:/data"
  bool live = false;                       // a camera: cannot wait, seek or be paused without losing frames
  bool endless = false;                    // a simulated closed path walks on without end
  std::optional<std::int64_t> num_frames;  // of a recording
  std::int64_t first_timestamp_ns = 0;     // of a recording
  std::int64_t last_timestamp_ns = 0;
  std::string
      assumed{};  // what the recording does not say and was taken for granted, in words; usually empty
};

/// Frames that could not be delivered, and why the newest of them could not, or none can be at the moment.
struct SkippedFrames {
  std::int64_t count = 0;
  std::string last_reason;  // names the file, as "cam0/data/17.png: truncated PNG"; without any: of an outage
};

/// Where stereo pairs come from. All calls but stop() are made by one thread.
/// Opening a source throws std::runtime_error with file, field and value if it cannot deliver anything.
class StereoSource {
 public:
  virtual ~StereoSource() = default;

  /// The next pair; blocks. Nothing at the end of a recording and after stop(). Timestamps increase strictly.
  /// A pair that cannot be read (missing partner, truncated picture) is skipped and counted, never thrown.
  virtual std::optional<StereoFrame> next() = 0;

  /// Makes a blocked next() return nothing, and every later one. May be called from any thread.
  virtual void stop() = 0;

  [[nodiscard]] virtual SourceInfo info() const = 0;

  /// The calibration that the source carries; nothing if it has none (then --calibration is needed).
  [[nodiscard]] virtual std::optional<StereoCalibration> calibration() const = 0;

  [[nodiscard]] virtual SkippedFrames skipped() const { return {}; }

  /// While next() waits for something that may never come, a camera that was unplugged for instance, it calls
  /// `tell` when that begins and when it ends, from its own thread; skipped() then says what it is.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): those who override it keep it.
  virtual void on_trouble(std::function<void()> /*tell*/) {}

  /// Nothing where pairs have one time only.
  [[nodiscard]] virtual std::optional<PairSkew> skew() const { return std::nullopt; }

  /// Goes to the first frame at or after this time; false where the source cannot.
  virtual bool seek(std::int64_t /*timestamp_ns*/) { return false; }

  /// "Up" (against gravity), unit length, in the raw left camera at the first frame, from an inertial sensor
  /// at rest; nothing where there is none.
  [[nodiscard]] virtual std::optional<Eigen::Vector3d> up_in_left_camera() const { return std::nullopt; }

  /// The true pose world_from_left (rectified left camera) of a delivered frame; only simulated sources know.
  [[nodiscard]] virtual std::optional<Eigen::Isometry3d> true_pose(std::int64_t /*timestamp_ns*/) const {
    return std::nullopt;
  }
};

}  // namespace flogmap
