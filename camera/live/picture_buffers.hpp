// Memory that a camera writes its pictures to.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "camera/live/luma.hpp"

namespace libcamera {
class Camera;
class FrameBuffer;
class FrameBufferAllocator;
struct StreamConfiguration;
}  // namespace libcamera

namespace flogmap {

/// Buffers of the kernel's, or, where it has no device for them, plain memory (memfd); mapped for reading.
class PictureBuffers {
 public:
  /// The camera is configured. Throws std::runtime_error naming it if there is no memory.
  PictureBuffers(const std::shared_ptr<libcamera::Camera>& camera,
                 const libcamera::StreamConfiguration& configuration);
  ~PictureBuffers();
  PictureBuffers(const PictureBuffers&) = delete;
  PictureBuffers& operator=(const PictureBuffers&) = delete;

  [[nodiscard]] const std::vector<libcamera::FrameBuffer*>& all() const { return buffers_; }
  /// The first plane of a buffer, as the configuration lays it out.
  [[nodiscard]] RawPlane plane(const libcamera::FrameBuffer& buffer,
                               const libcamera::StreamConfiguration& configuration) const;

 private:
  bool make_memory(const libcamera::StreamConfiguration& configuration);
  bool map(const libcamera::FrameBuffer& buffer);

  struct Mapping {
    void* address = nullptr;
    std::size_t size = 0;
  };
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
  std::vector<std::unique_ptr<libcamera::FrameBuffer>> own_;
  std::vector<libcamera::FrameBuffer*> buffers_;
  std::map<const libcamera::FrameBuffer*, Mapping> mappings_;
};

}  // namespace flogmap
