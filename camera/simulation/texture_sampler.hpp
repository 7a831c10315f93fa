// How a texture looks through pixels of a given size: two mip levels, bilinear in each.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "camera/simulation/mip_texture.hpp"
#include "camera/simulation/screen_face.hpp"

namespace flogmap {

/// The two levels next to a footprint, blended.
class TextureSampler {
 public:
  /// The area of the footprint in texels of the finest level, squared sides.
  TextureSampler(const MipTexture& texture, float footprint) {
    const auto& levels = texture.levels();
    const auto coarsest = static_cast<float>(levels.size() - 1);
    const float level = std::min(0.5F * std::log2(std::max(footprint, 1.0F)), coarsest);
    const auto fine = static_cast<std::size_t>(level);
    fine_ = &levels[fine];
    coarse_ = &levels[std::min(fine + 1, levels.size() - 1)];
    coarse_share_ = static_cast<std::int32_t>((level - static_cast<float>(fine)) * 256.0F);
  }

  /// Grey times 2^8 at positions in texels of the finest level, whose texel (i, j) covers [i, i+1) x [j,
  /// j+1).
  template <std::size_t Count>
  [[nodiscard]] std::array<std::int32_t, Count> operator()(const std::array<float, Count>& u,
                                                           const std::array<float, Count>& v) const {
    std::array<std::int32_t, Count> grey = bilinear(*fine_, u, v);
    if (coarse_share_ == 0) return grey;
    const std::array<std::int32_t, Count> coarse = bilinear(*coarse_, u, v);
    for (std::size_t i = 0; i < Count; ++i) grey[i] += ((coarse[i] - grey[i]) * coarse_share_) >> 8;
    return grey;
  }

 private:
  /// Positions first, then the loads, then the blends: the first and the last are done several at a time.
  template <std::size_t Count>
  static std::array<std::int32_t, Count> bilinear(const MipTexture::Level& level,
                                                  const std::array<float, Count>& u,
                                                  const std::array<float, Count>& v) {
    std::array<std::int32_t, Count> at, tx, ty, a, b, c, d, grey;
    const float scale = level.scale, max_x = level.max_x, max_y = level.max_y;
    const std::int32_t stride = level.stride;
    for (std::size_t i = 0; i < Count; ++i) {
      const float x = std::min(std::max(u[i] * scale - 0.5F, 0.0F), max_x);
      const float y = std::min(std::max(v[i] * scale - 0.5F, 0.0F), max_y);
      const auto xi = static_cast<std::int32_t>(x * 256.0F), yi = static_cast<std::int32_t>(y * 256.0F);
      at[i] = (yi >> 8) * stride + (xi >> 8);
      tx[i] = xi & 255;
      ty[i] = yi & 255;
    }
    const std::uint8_t* texels = level.texels.data();
    for (std::size_t i = 0; i < Count; ++i) {
      const std::uint8_t* p = texels + at[i];
      a[i] = p[0], b[i] = p[1], c[i] = p[stride], d[i] = p[stride + 1];
    }
    for (std::size_t i = 0; i < Count; ++i) {
      const std::int32_t upper = a[i] * 256 + (b[i] - a[i]) * tx[i];
      const std::int32_t lower = c[i] * 256 + (d[i] - c[i]) * tx[i];
      grey[i] = upper + (((lower - upper) * ty[i]) >> 8);
    }
    return grey;
  }

  const MipTexture::Level* fine_ = nullptr;
  const MipTexture::Level* coarse_ = nullptr;
  std::int32_t coarse_share_ = 0;
};

/// The squared side, in texels, of a pixel's footprint at (x, y): the product of its two sides, but at least
/// a quarter of the longer one squared, so that a floor seen at a low angle neither flickers nor blurs away.
[[nodiscard]] inline float footprint_texels(const ScreenFace& face, double x, double y) {
  const Affine &w = face.inverse_depth, &s = face.u_over_depth, &t = face.v_over_depth;
  const double depth = 1 / w(x, y);
  const double u = s(x, y) * depth, v = t(x, y) * depth;
  const auto squared = [depth](double du, double dv) { return (du * du + dv * dv) * depth * depth; };
  const double across = squared(s.per_x - u * w.per_x, t.per_x - v * w.per_x);
  const double down = squared(s.per_y - u * w.per_y, t.per_y - v * w.per_y);
  return static_cast<float>(std::max(std::sqrt(across * down), 0.25 * std::max(across, down)));
}

}  // namespace flogmap
