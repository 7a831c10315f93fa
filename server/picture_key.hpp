#pragma once

#include <compare>

#include "server/client_message.hpp"

namespace flogmap {

/// A picture in the size that somebody wants.
struct PictureKey {
  ImageStream stream = ImageStream::left;
  int max_width_px = 0;  // 0: full size
  auto operator<=>(const PictureKey&) const = default;
};

/// Sizes are rounded down to a few, so that many pages share few pictures.
PictureKey picture_key(const ImageRequest& request);

}  // namespace flogmap
