#include "camera/simulation/mip_texture.hpp"

#include <algorithm>
#include <cstring>

namespace flogmap {
namespace {

MipTexture::Level padded(const Image<std::uint8_t>& image) {
  MipTexture::Level level;
  level.stride = image.width + 1;
  level.texels.resize(static_cast<std::size_t>(level.stride) * (image.height + 1));
  for (int y = 0; y <= image.height; ++y) {
    const std::uint8_t* row = image.row(std::min(y, image.height - 1));
    std::uint8_t* out = level.texels.data() + static_cast<std::size_t>(y) * level.stride;
    std::memcpy(out, row, image.width);
    out[image.width] = row[image.width - 1];
  }
  level.max_x = static_cast<float>(image.width) - 1.0F;
  level.max_y = static_cast<float>(image.height) - 1.0F;
  return level;
}

Image<std::uint8_t> halved(const Image<std::uint8_t>& image) {
  Image<std::uint8_t> half((image.width + 1) / 2, (image.height + 1) / 2);
  for (int y = 0; y < half.height; ++y) {
    const std::uint8_t* upper = image.row(2 * y);
    const std::uint8_t* lower = image.row(std::min(2 * y + 1, image.height - 1));
    for (int x = 0; x < half.width; ++x) {
      const int next = std::min(2 * x + 1, image.width - 1);
      half.at(x, y) =
          static_cast<std::uint8_t>((upper[2 * x] + upper[next] + lower[2 * x] + lower[next] + 2) / 4);
    }
  }
  return half;
}

}  // namespace

MipTexture::MipTexture(const Image<std::uint8_t>& finest) {
  Image<std::uint8_t> image = finest;
  levels_.push_back(padded(image));
  while (image.width > 2 && image.height > 2) {
    image = halved(image);
    levels_.push_back(padded(image));
    levels_.back().scale = levels_[levels_.size() - 2].scale / 2;
  }
}

}  // namespace flogmap
