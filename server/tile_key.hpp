#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "mapping/flog/grid_spec.hpp"

namespace flogmap {

/// Overview levels of every map, level 0 included: the coarsest cell is 2^5 times as large.
inline constexpr int kOverviewLevels = 6;

/// Tile (x, y) of level k covers [x s, (x + 1) s) x [y s, (y + 1) s) metres, s = 64 * 2^k * cell size. y is
/// up.
struct TileKey {
  std::uint32_t level = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
  auto operator<=>(const TileKey&) const = default;
};

/// The tile of the next coarser level that covers this one.
constexpr TileKey parent_of(TileKey key) { return {key.level + 1, key.x >> 1, key.y >> 1}; }

/// Child 0 .. 3 of the next finer level: 0 lower left, 1 lower right, 2 upper left, 3 upper right.
constexpr TileKey child_of(TileKey key, int child) {
  return {key.level - 1, key.x * 2 + (child & 1), key.y * 2 + (child >> 1)};
}

/// Side of a tile, metres.
inline double tile_side_m(const GridSpec& grid, std::uint32_t level) {
  return grid.cell_size_m * kTileSide * static_cast<double>(std::uint64_t{1} << level);
}

/// An axis-aligned rectangle in the world, metres.
struct Bounds {
  double x_min = 0;
  double y_min = 0;
  double x_max = 0;
  double y_max = 0;
  bool operator==(const Bounds&) const = default;
};

inline Bounds tile_bounds(const GridSpec& grid, TileKey key) {
  const double side = tile_side_m(grid, key.level);
  return {key.x * side, key.y * side, (key.x + 1.0) * side, (key.y + 1.0) * side};
}

inline bool intersect(const Bounds& a, const Bounds& b) {
  return a.x_min < b.x_max && b.x_min < a.x_max && a.y_min < b.y_max && b.y_min < a.y_max;
}

struct TileKeyHash {
  std::size_t operator()(const TileKey& key) const {
    const auto x = static_cast<std::uint32_t>(key.x), y = static_cast<std::uint32_t>(key.y);
    std::uint64_t mixed = (std::uint64_t{x} << 32 | y) ^ (std::uint64_t{key.level} << 61);
    mixed = (mixed ^ (mixed >> 31)) * 0x9e3779b97f4a7c15ULL;
    return static_cast<std::size_t>(mixed ^ (mixed >> 29));
  }
};

}  // namespace flogmap
