#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera/stereo_source.hpp"

namespace flogmap {

/// Two files and when they were taken.
struct PicturePair {
  std::int64_t timestamp_ns = 0;
  std::filesystem::path left, right;
};

/// Times of pictures that came at this rate, and the words for it where nothing says the times.
[[nodiscard]] std::int64_t time_at(std::size_t picture, double rate_hz);
[[nodiscard]] std::string assumed_rate(double rate_hz);

/// What a folder of pictures turned out to hold, whatever its layout.
struct PicturePairList {
  std::vector<PicturePair> pairs;  // times increase strictly
  SkippedFrames skipped;           // pairs left out while listing
  std::optional<StereoCalibration> calibration;
  std::optional<Eigen::Vector3d> up_in_left_camera;
  std::optional<PairSkew> skew;
  std::string assumed;  // as SourceInfo::assumed

  void skip(std::string reason) { ++skipped.count, skipped.last_reason = std::move(reason); }
};

/// Delivers listed picture pairs in order: what all recordings made of single pictures share.
class PicturePairSource final : public StereoSource {
 public:
  /// Throws std::runtime_error if there is no pair, or if not one of the first pairs can be read.
  PicturePairSource(std::string spec, PicturePairList list, bool loop);

  std::optional<StereoFrame> next() override;
  void stop() override { stopped_ = true; }
  [[nodiscard]] SourceInfo info() const override;
  [[nodiscard]] std::optional<StereoCalibration> calibration() const override { return list_.calibration; }
  [[nodiscard]] SkippedFrames skipped() const override { return list_.skipped; }
  [[nodiscard]] std::optional<PairSkew> skew() const override { return list_.skew; }
  bool seek(std::int64_t timestamp_ns) override;
  [[nodiscard]] std::optional<Eigen::Vector3d> up_in_left_camera() const override {
    return list_.up_in_left_camera;
  }

 private:
  std::optional<StereoFrame> read(const PicturePair& pair);
  void find_picture_size();
  void find_unused_bits();

  std::string spec_;
  PicturePairList list_;
  bool loop_;
  std::size_t position_ = 0;
  int width_px_ = 0, height_px_ = 0;  // of the first readable pair; others are skipped
  int unused_bits_ = 0;               // see low_bits.hpp; the same for all pictures
  std::atomic<bool> stopped_ = false;
};

}  // namespace flogmap
