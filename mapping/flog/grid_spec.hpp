// The grid: cells, layers and tiles, and the way between metres and indices. FLOG.md section 6, paper 2.4.
#pragma once

#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flogmap {

inline constexpr int kTileShift = 6;
inline constexpr int kTileSide = 1 << kTileShift;  // columns along one side of a tile
inline constexpr int kTileMask = kTileSide - 1;
inline constexpr int kTileColumns = kTileSide * kTileSide;

/// Index of a column of cells: covers [x a, (x+1) a) x [y a, (y+1) a) in the world, a = cell size.
struct CellIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  auto operator<=>(const CellIndex&) const = default;
};

/// Index of a tile of 64 x 64 columns; signed, y up.
struct TileIndex {
  std::int32_t x = 0;
  std::int32_t y = 0;
  auto operator<=>(const TileIndex&) const = default;
};

/// Cell size and layers of a map. Layer k is [layer_bounds_m[k], layer_bounds_m[k + 1]).
struct GridSpec {
  double cell_size_m = 0.02;
  std::vector<double> layer_bounds_m{0.05, 0.75, 1.45, 2.15};  // rising; one more than there are layers

  [[nodiscard]] int num_layers() const { return static_cast<int>(layer_bounds_m.size()) - 1; }
  bool operator==(const GridSpec&) const = default;
};

/// The column that holds a point; metres.
inline CellIndex cell_at(const GridSpec& grid, double x_m, double y_m) {
  return {static_cast<std::int32_t>(std::floor(x_m / grid.cell_size_m)),
          static_cast<std::int32_t>(std::floor(y_m / grid.cell_size_m))};
}

/// Middle of a column along one axis, metres.
inline double cell_middle_m(const GridSpec& grid, std::int32_t index) {
  return (index + 0.5) * grid.cell_size_m;
}

/// The tile of a column. Arithmetic shift: right for negative indices too.
inline TileIndex tile_of(CellIndex cell) { return {cell.x >> kTileShift, cell.y >> kTileShift}; }

/// Place of a column within its tile's plane, 0 .. 4095: row-major, row 0 at the lowest y.
inline int column_in_tile(CellIndex cell) {
  return ((cell.y & kTileMask) << kTileShift) | (cell.x & kTileMask);
}

/// First (lowest x and y) column of a tile.
inline CellIndex first_cell(TileIndex tile) { return {tile.x << kTileShift, tile.y << kTileShift}; }

/// Throws std::invalid_argument naming field, value and what is allowed.
void check(const GridSpec& grid);

}  // namespace flogmap
