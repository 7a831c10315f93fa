// One libcamera camera: buffers, requests, controls.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "camera/live/camera_rig.hpp"

namespace libcamera {
class Camera;
}

namespace flogmap {

class LibcameraCamera {
 public:
  using Clock = std::chrono::steady_clock;
  using OnPicture = std::function<void(RigPicture)>;
  using OnLost = std::function<void(std::string)>;

  /// Configures and starts. The callbacks come in libcamera's thread and must return soon. Throws
  /// std::runtime_error naming the camera and what it refused.
  LibcameraCamera(std::shared_ptr<libcamera::Camera> camera, Side side, const RigOptions& options,
                  OnPicture on_picture, OnLost on_lost);
  ~LibcameraCamera();
  LibcameraCamera(const LibcameraCamera&) = delete;
  LibcameraCamera& operator=(const LibcameraCamera&) = delete;

  /// Gives buffers back to the camera, at most at the frame rate: cameras without a sensor know no other
  /// pace. Returns when it wants to be called again.
  Clock::time_point queue_free_requests();

  void set_duration(std::int64_t duration_ns);
  void set_exposure(double exposure_us, double gain);
  /// Raspberry Pi's libcamera synchronises this camera itself.
  [[nodiscard]] bool keeps_step() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flogmap
