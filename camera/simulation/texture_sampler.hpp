// How a texture looks through pixels of a given size: two mip levels, bilinear in each.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "camera/simulation/mip_texture.hpp"
#include "camera/simulation/screen_face.hpp"

namespace flogmap {

/// The two levels next to a footprint and the share of the coarser one.
class TextureSampler {
 public:
  /// Footprint in texels of the finest level.
  TextureSampler(const MipTexture& texture, float footprint) {
    const auto& levels = texture.levels();
    const float level =
        std::clamp(std::log2(std::max(footprint, 1e-6F)), 0.0F, static_cast<float>(levels.size() - 1));
    const auto fine = static_cast<std::size_t>(level);
    const std::size_t coarse = std::min(fine + 1, levels.size() - 1);
    fine_ = at_level(levels[fine], fine);
    coarse_ = at_level(levels[coarse], coarse);
    coarse_share_ = static_cast<std::int32_t>((level - static_cast<float>(fine)) * 256.0F);
  }

  /// Grey times 2^8 at a position in texels of the finest level, whose texel (i, j) covers [i, i+1) x [j,
  /// j+1).
  [[nodiscard]] std::int32_t operator()(float u, float v) const {
    const std::int32_t fine = bilinear(fine_, u, v);
    if (coarse_share_ == 0) return fine;
    return fine + (((bilinear(coarse_, u, v) - fine) * coarse_share_) >> 8);
  }

 private:
  struct ScaledLevel {
    const std::uint8_t* texels = nullptr;
    std::int32_t stride = 0;
    float scale = 1, max_x = 0, max_y = 0;
  };

  static ScaledLevel at_level(const MipTexture::Level& level, std::size_t index) {
    return {level.texels.data(), level.stride, std::ldexp(1.0F, -static_cast<int>(index)), level.max_x,
            level.max_y};
  }

  static std::int32_t bilinear(const ScaledLevel& level, float u, float v) {
    const float x = std::min(std::max(u * level.scale - 0.5F, 0.0F), level.max_x);
    const float y = std::min(std::max(v * level.scale - 0.5F, 0.0F), level.max_y);
    const auto xi = static_cast<std::int32_t>(x * 256.0F), yi = static_cast<std::int32_t>(y * 256.0F);
    const std::uint8_t* p = level.texels + (yi >> 8) * level.stride + (xi >> 8);
    const std::int32_t tx = xi & 255, ty = yi & 255;
    const std::int32_t upper = p[0] * 256 + (p[1] - p[0]) * tx;
    const std::uint8_t* q = p + level.stride;
    const std::int32_t lower = q[0] * 256 + (q[1] - q[0]) * tx;
    return upper + (((lower - upper) * ty) >> 8);
  }

  ScaledLevel fine_, coarse_;
  std::int32_t coarse_share_ = 0;
};

/// The side, in texels, of a pixel's footprint at (x, y): the mean of its two sides, but at least half the
/// longer, so that a floor seen at a low angle neither flickers nor blurs away.
[[nodiscard]] inline float footprint_texels(const ScreenFace& face, double x, double y) {
  const double w = face.inverse_depth(x, y);
  const double u = face.u_over_depth(x, y) / w, v = face.v_over_depth(x, y) / w;
  const auto side = [&](double du, double dv, double dw) {
    return std::hypot((du - u * dw) / w, (dv - v * dw) / w);
  };
  const double a = side(face.u_over_depth.per_x, face.v_over_depth.per_x, face.inverse_depth.per_x);
  const double b = side(face.u_over_depth.per_y, face.v_over_depth.per_y, face.inverse_depth.per_y);
  return static_cast<float>(std::max(std::sqrt(a * b), 0.5 * std::max(a, b)));
}

}  // namespace flogmap
