#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "camera/calibration/stereo_calibration.hpp"
#include "camera/stereo_frame.hpp"

namespace flogmap {

/// Writes a recording in the EuRoC layout, calibration included: the inverse of reading "euroc:DIR". A pair
/// is listed only when both its pictures are complete, so that a recording broken off at any time is a
/// shorter recording. Pairs of live cameras also get a line in mav0/capture.csv: skew, exposure and gain.
class RecordingWriter {
 public:
  struct Options {
    bool compress = true;  // PNG or JPEG; else PGM or PPM, which is several times faster and larger
    bool lossy = false;    // of the compressed ones: JPEG, small and not quite what was seen
    double rate_hz = 0;    // written down for readers; 0: unknown
    std::optional<Eigen::Vector3d> up_in_left_camera{};  // as StereoSource says it; kept in cam0/sensor.yaml
    std::string about{};  // written to recording.json: where the pairs come from; empty: no such file
  };

  /// Throws std::runtime_error if the folder holds a recording already.
  static void require_free(const std::filesystem::path& folder);

  /// Throws std::runtime_error if the folder holds a recording already or cannot be written.
  RecordingWriter(std::filesystem::path folder, const StereoCalibration& calibration, Options options);

  /// Writes one pair and, if known, its true pose world_from_left (rectified left camera).
  /// Throws std::runtime_error naming the file, as when the disk is full; nothing half-written is listed
  /// then.
  void write(const StereoFrame& frame,
             const std::optional<Eigen::Isometry3d>& world_from_left = std::nullopt);

  [[nodiscard]] std::int64_t num_written() const { return num_written_; }

 private:
  void write_picture_whole(const std::filesystem::path& file, const Picture& picture) const;
  void write_details(const StereoFrame& frame);
  void write_pose(std::int64_t timestamp_ns, const Eigen::Isometry3d& world_from_left);

  std::filesystem::path folder_;
  Eigen::Isometry3d left_from_body_;
  Options options_;
  std::ofstream left_csv_, right_csv_, truth_csv_, truth_tum_, capture_csv_;
  std::int64_t num_written_ = 0;
};

/// A time as "1700000000.123456789": whole nanoseconds, nothing rounded.
[[nodiscard]] std::string seconds_text(std::int64_t timestamp_ns);

/// Writes a float image as PFM (little-endian, lowest row first); throws std::runtime_error naming the file.
void write_pfm(const std::filesystem::path& file, const Image<float>& image);

}  // namespace flogmap
