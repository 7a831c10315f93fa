// Mapped views as bytes: disparity and picture, small enough to keep hundreds of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/stored_view.hpp"

namespace flogmap {

/// StoredView::codec of what pack_view() writes.
inline constexpr int kMeshViewCodec = 2;

/// A view as it comes out again: every `step`-th pixel's disparity in both directions, and the picture.
struct UnpackedView {
  int width_px = 0, height_px = 0;  // of the rectified left picture
  int step = 1;                     // sample (i, j) is of pixel (i * step, j * step)
  Image<float> disparity_px;        // multiples of 1/64 px; NaN: no match
  std::string jpeg;                 // the whole picture, perhaps smaller
};

/// Disparities are rounded to 1/64 px and sampled so that about 100,000 remain; the picture becomes a JPEG at
/// most 1024 wide. Throws std::invalid_argument if picture and disparity differ in size or are empty.
StoredView pack_view(const View& view, std::int64_t number);

/// Nothing if the codec is another or the bytes are damaged.
std::optional<UnpackedView> unpack_view(const StoredView& view);

}  // namespace flogmap
