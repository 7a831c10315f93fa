// Smooth random functions of the plane, the same on every machine: integer hashes and a few multiplications.
#pragma once

#include <cmath>
#include <cstdint>

namespace flogmap {

/// A well mixed 32-bit value of three integers.
[[nodiscard]] constexpr std::uint32_t mixed(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x8DA6B343U ^ y * 0xD8163841U ^ seed * 0xCB1AB31FU;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  return h ^ (h >> 15);
}

/// Uniform in [0, 1), constant on the unit squares of the plane.
[[nodiscard]] inline double cell_noise(double x, double y, std::uint32_t seed) {
  const auto ix = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(x)));
  const auto iy = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(y)));
  return mixed(ix, iy, seed) * 0x1p-32;
}

[[nodiscard]] constexpr double smooth_step(double edge0, double edge1, double x) {
  const double raw = (x - edge0) / (edge1 - edge0);
  const double t = raw < 0 ? 0 : raw > 1 ? 1 : raw;
  return t * t * (3 - 2 * t);
}

/// Smooth in [0, 1], with features of about one unit.
[[nodiscard]] inline double value_noise(double x, double y, std::uint32_t seed) {
  const double fx = std::floor(x), fy = std::floor(y);
  const double tx = smooth_step(0, 1, x - fx), ty = smooth_step(0, 1, y - fy);
  const double low = cell_noise(fx, fy, seed) * (1 - tx) + cell_noise(fx + 1, fy, seed) * tx;
  const double high = cell_noise(fx, fy + 1, seed) * (1 - tx) + cell_noise(fx + 1, fy + 1, seed) * tx;
  return low * (1 - ty) + high * ty;
}

/// Sum of `octaves` noises, each twice as fine and half as strong; in [0, 1], mean one half.
[[nodiscard]] inline double cloud_noise(double x, double y, int octaves, std::uint32_t seed) {
  double sum = 0, weight = 0, amplitude = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * value_noise(x, y, seed + static_cast<std::uint32_t>(octave));
    weight += amplitude;
    amplitude /= 2;
    x *= 2, y *= 2;
  }
  return sum / weight;
}

}  // namespace flogmap
