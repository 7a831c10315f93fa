// A picture cut into three by three areas: where the board has been seen, in words.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace flogmap {

inline constexpr int kAreasPerSide = 3;
inline constexpr std::size_t kNumAreas = 9;

/// Counts per area, row by row from the upper left.
using AreaCounts = std::array<int, kNumAreas>;

[[nodiscard]] inline std::size_t area_of(const Eigen::Vector2d& pixel, int width_px, int height_px) {
  const auto third = [](double at, int size) {
    return std::clamp(static_cast<int>(kAreasPerSide * at / size), 0, kAreasPerSide - 1);
  };
  const int area = kAreasPerSide * third(pixel.y(), height_px) + third(pixel.x(), width_px);
  return static_cast<std::size_t>(area);
}

[[nodiscard]] inline std::string area_name(std::size_t area) {
  static constexpr std::array<const char*, kNumAreas> kNames{"upper left", "upper middle", "upper right",
                                                             "left",       "centre",       "right",
                                                             "lower left", "lower middle", "lower right"};
  return kNames.at(area);
}

}  // namespace flogmap
