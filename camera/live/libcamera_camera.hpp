// One libcamera camera: buffers, requests, controls. For the .cpp files of this folder only.
#pragma once

#include <libcamera/libcamera.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "camera/live/camera_rig.hpp"
#include "camera/live/luma.hpp"

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
  [[nodiscard]] bool keeps_step() const { return sync_mode_.has_value(); }

 private:
  void configure(const RigOptions& options);
  void make_requests();
  bool make_memory_buffers();
  void map_buffer(const libcamera::FrameBuffer& buffer);
  [[nodiscard]] libcamera::ControlList first_controls(const RigOptions& options);
  [[nodiscard]] bool has(const libcamera::ControlId& control) const;
  void completed(libcamera::Request* request);
  [[nodiscard]] std::optional<RigPicture> picture_of(libcamera::Request* request) const;
  void was_disconnected();

  std::shared_ptr<libcamera::Camera> camera_;
  const Side side_;
  const std::int64_t period_ns_;
  OnPicture on_picture_;
  OnLost on_lost_;
  std::unique_ptr<libcamera::CameraConfiguration> configuration_;
  libcamera::Stream* stream_ = nullptr;
  LumaLayout layout_ = LumaLayout::planar8;
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
  std::vector<std::unique_ptr<libcamera::FrameBuffer>> own_buffers_;
  std::vector<std::unique_ptr<libcamera::Request>> requests_;
  struct Mapping {
    void* address = nullptr;
    std::size_t size = 0;
  };
  std::map<const libcamera::FrameBuffer*, Mapping> mappings_;
  std::optional<unsigned> sync_mode_, sync_ready_;  // ids of Raspberry Pi's controls, where there are any

  std::mutex mutex_;  // between libcamera's thread and ours
  std::vector<libcamera::Request*> free_;
  std::optional<std::int64_t> wanted_duration_ns_;
  std::optional<std::pair<double, double>> wanted_exposure_;
  double tokens_;  // requests that may be queued now
  Clock::time_point tokens_at_;
  bool running_ = false;
};

}  // namespace flogmap
