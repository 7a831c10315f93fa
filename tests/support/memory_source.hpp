#pragma once

#include <atomic>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "camera/stereo_source.hpp"

namespace flogmap {

/// The first frames of a source, held in memory.
struct RecordedFrames {
  std::vector<StereoFrame> frames;
  std::optional<StereoCalibration> calibration;
  std::optional<Eigen::Isometry3d> first_pose;  // world_from_left, where the source knows it
};

inline std::shared_ptr<const RecordedFrames> record_frames(StereoSource& source, std::size_t num_frames) {
  auto recorded = std::make_shared<RecordedFrames>();
  recorded->calibration = source.calibration();
  recorded->first_pose = source.true_pose(source.info().first_timestamp_ns);
  while (recorded->frames.size() < num_frames) {
    std::optional<StereoFrame> frame = source.next();
    if (!frame) break;
    recorded->frames.push_back(std::move(*frame));
  }
  if (recorded->frames.empty()) throw std::runtime_error(source.info().spec + ": has no frame");
  return recorded;
}

/// A seekable recording of frames in memory, so that reading and decoding cost nothing. It fails on demand.
class MemorySource final : public StereoSource {
 public:
  explicit MemorySource(std::shared_ptr<const RecordedFrames> recorded) : recorded_(std::move(recorded)) {}

  /// next() throws when it comes to this frame.
  void fail_at(std::size_t frame) { fail_at_ = frame; }

  std::optional<StereoFrame> next() override {
    if (stopped_ || next_ >= recorded_->frames.size()) return std::nullopt;
    if (next_ == fail_at_) throw std::runtime_error("the cable is out");
    return recorded_->frames[next_++];
  }
  void stop() override { stopped_ = true; }
  [[nodiscard]] SourceInfo info() const override {
    SourceInfo info;
    info.spec = "memory:recording";
    info.num_frames = static_cast<std::int64_t>(recorded_->frames.size());
    info.first_timestamp_ns = recorded_->frames.front().timestamp_ns;
    info.last_timestamp_ns = recorded_->frames.back().timestamp_ns;
    return info;
  }
  [[nodiscard]] std::optional<StereoCalibration> calibration() const override {
    return recorded_->calibration;
  }
  bool seek(std::int64_t timestamp_ns) override {
    const std::vector<StereoFrame>& frames = recorded_->frames;
    for (next_ = 0; next_ < frames.size() && frames[next_].timestamp_ns < timestamp_ns;) ++next_;
    return true;
  }

 private:
  std::shared_ptr<const RecordedFrames> recorded_;
  std::size_t next_ = 0;
  std::size_t fail_at_ = static_cast<std::size_t>(-1);
  std::atomic<bool> stopped_ = false;
};

}  // namespace flogmap
