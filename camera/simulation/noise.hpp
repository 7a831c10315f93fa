// Smooth random functions of the plane, the same on every machine: integer hashes and a few multiplications.
#pragma once

#include <cstdint>

namespace flogmap {

/// A well mixed 32-bit value of three integers.
[[nodiscard]] constexpr std::uint32_t mixed(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x8DA6B343U ^ y * 0xD8163841U ^ seed * 0xCB1AB31FU;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  return h ^ (h >> 15);
}

/// The largest integer not above x; |x| < 2^31. (std::floor is a call on machines without SSE 4.1.)
[[nodiscard]] constexpr std::int32_t floor_of(double x) {
  const auto whole = static_cast<std::int32_t>(x);
  return whole - (x < whole ? 1 : 0);
}

/// Uniform in [0, 1) at a point of the integer lattice.
[[nodiscard]] constexpr double lattice_noise(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  return mixed(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed) * 0x1p-32;
}

/// Uniform in [0, 1), constant on the unit squares of the plane.
[[nodiscard]] constexpr double cell_noise(double x, double y, std::uint32_t seed) {
  return lattice_noise(floor_of(x), floor_of(y), seed);
}

[[nodiscard]] constexpr double smooth_step(double edge0, double edge1, double x) {
  const double raw = (x - edge0) / (edge1 - edge0);
  const double t = raw < 0 ? 0 : raw > 1 ? 1 : raw;
  return t * t * (3 - 2 * t);
}

/// Smooth in [0, 1], with features of about one unit.
[[nodiscard]] constexpr double value_noise(double x, double y, std::uint32_t seed) {
  const std::int32_t ix = floor_of(x), iy = floor_of(y);
  const double fx = x - ix, fy = y - iy;
  const double tx = fx * fx * (3 - 2 * fx), ty = fy * fy * (3 - 2 * fy);
  const double a = lattice_noise(ix, iy, seed), b = lattice_noise(ix + 1, iy, seed);
  const double c = lattice_noise(ix, iy + 1, seed), d = lattice_noise(ix + 1, iy + 1, seed);
  const double low = a + (b - a) * tx, high = c + (d - c) * tx;
  return low + (high - low) * ty;
}

/// Sum of `octaves` noises, each twice as fine and half as strong; in [0, 1], mean one half.
[[nodiscard]] constexpr double cloud_noise(double x, double y, int octaves, std::uint32_t seed) {
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
