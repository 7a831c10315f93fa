#pragma once

#include <cstdint>
#include <vector>

#include "camera/image.hpp"

namespace flogmap {

/// A picture at every scale: level k has half the texels of level k - 1 in each direction, each the mean of
/// four. Every level carries one texel more to the right and below, so that bilinear sampling needs no test.
class MipTexture {
 public:
  struct Level {
    std::vector<std::uint8_t> texels;
    int stride = 0;
    float scale = 1;             // texels of this level per texel of the finest
    float max_x = 0, max_y = 0;  // largest position that may be sampled
  };

  MipTexture() = default;
  explicit MipTexture(const Image<std::uint8_t>& finest);

  [[nodiscard]] const std::vector<Level>& levels() const { return levels_; }

 private:
  std::vector<Level> levels_;
};

}  // namespace flogmap
