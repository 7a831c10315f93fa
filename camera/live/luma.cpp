#include "camera/live/luma.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace flogmap {
namespace {

struct NamedLayout {
  std::string_view name;
  LumaLayout layout;
};

constexpr std::array kLayouts{NamedLayout{"NV12", LumaLayout::planar8},
                              NamedLayout{"NV21", LumaLayout::planar8},
                              NamedLayout{"YUV420", LumaLayout::planar8},
                              NamedLayout{"YVU420", LumaLayout::planar8},
                              NamedLayout{"R8", LumaLayout::planar8},
                              NamedLayout{"YUYV", LumaLayout::interleaved8},
                              NamedLayout{"R10_CSI2P", LumaLayout::packed10},
                              NamedLayout{"SRGGB8", LumaLayout::bayer8},
                              NamedLayout{"SGRBG8", LumaLayout::bayer8},
                              NamedLayout{"SGBRG8", LumaLayout::bayer8},
                              NamedLayout{"SBGGR8", LumaLayout::bayer8},
                              NamedLayout{"SRGGB10_CSI2P", LumaLayout::bayer10},
                              NamedLayout{"SGRBG10_CSI2P", LumaLayout::bayer10},
                              NamedLayout{"SGBRG10_CSI2P", LumaLayout::bayer10},
                              NamedLayout{"SBGGR10_CSI2P", LumaLayout::bayer10}};

/// Where the upper eight bits of a pixel are in its row.
std::size_t byte_of(int x, LumaLayout layout) {
  const auto column = static_cast<std::size_t>(x);
  switch (layout) {
    case LumaLayout::interleaved8:
      return 2 * column;
    case LumaLayout::packed10:
    case LumaLayout::bayer10:
      return column / 4 * 5 + column % 4;
    case LumaLayout::planar8:
    case LumaLayout::bayer8:
      break;
  }
  return column;
}

}  // namespace

std::optional<LumaLayout> luma_layout(std::string_view pixel_format) {
  const auto* found = std::find_if(kLayouts.begin(), kLayouts.end(),
                                   [&](const NamedLayout& known) { return known.name == pixel_format; });
  return found == kLayouts.end() ? std::nullopt : std::optional(found->layout);
}

Picture grey_from_plane(const RawPlane& plane, LumaLayout layout) {
  if (plane.width <= 0 || plane.height <= 0) return {};
  const std::size_t row_bytes = byte_of(plane.width - 1, layout) + 1;
  if (plane.stride < row_bytes ||
      plane.size < plane.stride * static_cast<std::size_t>(plane.height - 1) + row_bytes)
    return {};
  const auto raw = [&](int x, int y) -> unsigned {
    return plane.bytes[static_cast<std::size_t>(y) * plane.stride + byte_of(x, layout)];
  };
  const bool bayer = layout == LumaLayout::bayer8 || layout == LumaLayout::bayer10;
  Picture picture{plane.width, plane.height, 1, 8, {}};
  picture.bytes.reserve(static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height));
  for (int y = 0; y < plane.height; ++y) {
    const int row = bayer ? std::max(0, std::min(y, plane.height - 2)) : y;
    const std::uint8_t* bytes = plane.bytes + static_cast<std::size_t>(y) * plane.stride;
    if (layout == LumaLayout::planar8) {
      picture.bytes.insert(picture.bytes.end(), bytes, bytes + plane.width);
      continue;
    }
    for (int x = 0; x < plane.width; ++x) {
      unsigned value = raw(x, y);
      if (bayer && plane.width > 1 && plane.height > 1) {
        const int column = std::min(x, plane.width - 2);
        value =
            (raw(column, row) + raw(column + 1, row) + raw(column, row + 1) + raw(column + 1, row + 1) + 2) /
            4;
      }
      picture.bytes.push_back(static_cast<std::uint8_t>(value));
    }
  }
  return picture;
}

}  // namespace flogmap
