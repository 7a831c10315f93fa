#include "camera/live/picture_buffers.hpp"

#include <libcamera/libcamera.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace flogmap {

namespace lc = libcamera;

PictureBuffers::PictureBuffers(const std::shared_ptr<lc::Camera>& camera,
                               const lc::StreamConfiguration& configuration)
    : allocator_(std::make_unique<lc::FrameBufferAllocator>(camera)) {
  lc::Stream* stream = configuration.stream();
  if (allocator_->allocate(stream) > 0) {
    for (const auto& buffer : allocator_->buffers(stream)) buffers_.push_back(buffer.get());
  } else if (make_memory(configuration)) {
    for (const auto& buffer : own_) buffers_.push_back(buffer.get());
  }
  const bool mapped =
      std::all_of(buffers_.begin(), buffers_.end(), [&](const auto* buffer) { return map(*buffer); });
  if (buffers_.empty() || !mapped)
    throw std::runtime_error("camera " + camera->id() + ": no memory for pictures");
}

PictureBuffers::~PictureBuffers() {
  for (const auto& [buffer, mapping] : mappings_) ::munmap(mapping.address, mapping.size);
}

bool PictureBuffers::make_memory(const lc::StreamConfiguration& configuration) {
  if (configuration.frameSize == 0) return false;
  const unsigned luma = std::min(configuration.stride * configuration.size.height, configuration.frameSize);
  for (unsigned i = 0; i < configuration.bufferCount; ++i) {
    const int file = ::memfd_create("flogmap-picture", MFD_CLOEXEC);
    if (file < 0) return false;
    const lc::SharedFD shared(lc::UniqueFD{file});
    if (::ftruncate(file, static_cast<off_t>(configuration.frameSize)) != 0) return false;
    std::vector<lc::FrameBuffer::Plane> planes(1);
    planes[0].fd = shared;
    planes[0].offset = 0;
    planes[0].length = luma;
    if (configuration.frameSize > luma) {
      planes.push_back(planes[0]);
      planes[1].offset = luma;
      planes[1].length = configuration.frameSize - luma;
    }
    own_.push_back(std::make_unique<lc::FrameBuffer>(planes));
  }
  return true;
}

/// Kernel buffers can only be mapped from their beginning; a plane begins at its offset.
bool PictureBuffers::map(const lc::FrameBuffer& buffer) {
  const auto& plane = buffer.planes()[0];
  const std::size_t size = plane.offset + plane.length;
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, plane.fd.get(), 0);
  if (address == MAP_FAILED) return false;
  mappings_[&buffer] = {address, size};
  return true;
}

RawPlane PictureBuffers::plane(const lc::FrameBuffer& buffer,
                               const lc::StreamConfiguration& configuration) const {
  const auto& plane = buffer.planes()[0];
  return {static_cast<const std::uint8_t*>(mappings_.at(&buffer).address) + plane.offset, plane.length,
          configuration.stride, static_cast<int>(configuration.size.width),
          static_cast<int>(configuration.size.height)};
}

}  // namespace flogmap
