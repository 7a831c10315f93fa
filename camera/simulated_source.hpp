#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "camera/simulation/renderer.hpp"
#include "camera/simulation/sensor_model.hpp"
#include "camera/simulation/walk.hpp"
#include "camera/stereo_source.hpp"

namespace flogmap {

/// A stereo camera carried through a simulated scene: rectified pictures, exact poses and depth. A closed
/// path walks on without end, an open one ends. The same scene and seed give the same pictures.
class SimulatedSource final : public StereoSource {
 public:
  SimulatedSource(std::string spec, const Scene& scene, std::uint64_t seed);

  std::optional<StereoFrame> next() override;
  void stop() override { stopped_ = true; }
  [[nodiscard]] SourceInfo info() const override;
  [[nodiscard]] std::optional<StereoCalibration> calibration() const override;
  [[nodiscard]] SkippedFrames skipped() const override { return skipped_; }
  bool seek(std::int64_t timestamp_ns) override;
  /// What an ideal inertial sensor would say.
  [[nodiscard]] std::optional<Eigen::Vector3d> up_in_left_camera() const override;
  [[nodiscard]] std::optional<Eigen::Isometry3d> true_pose(std::int64_t timestamp_ns) const override;

  /// Z of the left camera at the pixels of the newest frame [m]; infinity where there is nothing.
  [[nodiscard]] Image<float> true_depth() const;
  [[nodiscard]] const Image<float>& true_inverse_depth() const { return left_.inverse_depth; }
  [[nodiscard]] const Scene& scene() const { return renderer_.scene(); }

 private:
  [[nodiscard]] double seconds(std::int64_t timestamp_ns) const;
  [[nodiscard]] std::int64_t timestamp(std::int64_t frame) const;
  Picture picture(const Eigen::Isometry3d& world_from_camera, double time_s, RenderedView& view, bool right);

  std::string spec_;
  Renderer renderer_;
  Walk walk_;
  SensorModel sensor_;
  std::int64_t num_frames_ = 0;  // 0: endless
  std::int64_t frame_ = 0;
  RenderedView left_, right_;
  SkippedFrames skipped_;
  std::atomic<bool> stopped_ = false;
};

/// What any scene's camera would be calibrated to.
[[nodiscard]] StereoCalibration ideal_calibration(const StereoCamera& camera, const std::string& origin);

}  // namespace flogmap
