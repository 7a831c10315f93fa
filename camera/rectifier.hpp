#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "camera/calibration/stereo_calibration.hpp"
#include "camera/stereo_camera.hpp"
#include "camera/stereo_frame.hpp"

namespace flogmap {

/// Raw pair → rectified grey pair. The maps are computed once, at construction; the new camera is chosen so
/// that both rectified pictures are filled to their borders (at most 110 degrees wide). Pictures that are
/// rectified already pass through untouched.
class Rectifier {
 public:
  /// Throws std::runtime_error naming the calibration's origin and field if it cannot be a stereo pair.
  explicit Rectifier(const StereoCalibration& calibration);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  /// The pair after rectification.
  [[nodiscard]] const StereoCamera& camera() const { return camera_; }

  /// Turns the raw left camera's axes into the rectified ones; a pure rotation.
  [[nodiscard]] const Eigen::Isometry3d& rectified_from_raw_left() const { return rectified_from_raw_left_; }

  /// Colour becomes grey, 16 bits become 8 (the upper ones). Throws std::runtime_error if the pictures do not
  /// have the size that the calibration says.
  [[nodiscard]] RectifiedFrame rectify(const StereoFrame& frame) const;

 private:
  struct Maps;
  StereoCamera camera_;
  Eigen::Isometry3d rectified_from_raw_left_ = Eigen::Isometry3d::Identity();
  std::unique_ptr<Maps> left_, right_;  // null: pass through
};

}  // namespace flogmap
