#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "camera/image.hpp"

namespace flogmap {

/// How a camera lays out its first plane. Colours in other planes are not needed: stereo sees grey.
enum class LumaLayout : std::uint8_t {
  planar8,       // NV12, NV21, YUV420, R8: one byte per pixel
  interleaved8,  // YUYV: every second byte
  packed10,      // R10_CSI2P (Y10P): four upper bytes, then one with the lower bits
  bayer8,        // SRGGB8 and its three kin
  bayer10,       // SRGGB10_CSI2P and kin: packed as packed10
};

/// By libcamera's name of a pixel format ("NV12", "SRGGB10_CSI2P"); nothing for layouts we do not read.
[[nodiscard]] std::optional<LumaLayout> luma_layout(std::string_view pixel_format);

struct RawPlane {
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  std::size_t stride = 0;  // bytes from one row to the next
  int width = 0;
  int height = 0;
};

/// The grey picture, 8 bits. Bayer mosaics become grey by the mean of each pixel's 2x2 neighbourhood, which
/// holds one red, two green and one blue, whatever their order; the last row and column repeat the one
/// before. Empty if the plane is too small for what it claims to hold.
[[nodiscard]] Picture grey_from_plane(const RawPlane& plane, LumaLayout layout);

}  // namespace flogmap
