#include "mapping/flog/map_merge.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <stdexcept>

#include "mapping/flog/map_area.hpp"
#include "tests/mapping/flog/map_canvas.hpp"

namespace flogmap {
namespace {

using test::kFreeCell;
using test::kOccupiedCell;
using test::MapCanvas;

MapCanvas random_map(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(-100, 100), membership(0, 32000), rays(1, 100);
  MapCanvas canvas;
  for (int i = 0; i < 3000; ++i) {
    const auto part = [&] { return static_cast<std::uint16_t>(membership(random)); };
    canvas.set({place(random), place(random)}, i % 3,
               Cell{part(), part(), static_cast<std::uint16_t>(rays(random)), 0});
  }
  return canvas;
}

TEST(MapMerge, WithAnEmptyMapChangesNothing) {
  const MapCanvas canvas = random_map(1);
  const MapSnapshot merged = merge_maps(canvas.map(), MapCanvas().map(), {});
  EXPECT_EQ(merged.tiles, canvas.map().tiles);
  const MapSnapshot other = merge_maps(MapCanvas().map(), canvas.map(), {});
  for (const auto& [index, tile] : canvas.map().tiles) EXPECT_EQ(other.tiles.at(index)->cells, tile->cells);
}

TEST(MapMerge, WeighsBothByTheirRays) {
  MapCanvas a, b;
  a.set({3, 4}, 1, Cell{60000, 0, 30, 0});
  b.set({3, 4}, 1, Cell{0, 60000, 90, 0});
  const Cell cell = cell_in(merge_maps(a.map(), b.map(), {}), {3, 4}, 1);
  EXPECT_EQ(cell.rays, 120);
  EXPECT_NEAR(cell.empty, 15000, 1);
  EXPECT_NEAR(cell.occupied, 45000, 1);
}

TEST(MapMerge, CountsNoMoreRaysThanTheCap) {
  MapCanvas a, b;
  a.set({0, 0}, 0, Cell{65535, 0, 250, 0});
  b.set({0, 0}, 0, Cell{65535, 0, 250, 0});
  EXPECT_EQ(cell_in(merge_maps(a.map(), b.map(), {}), {0, 0}, 0).rays, 300);
}

TEST(MapMerge, AShiftByWholeCellsIsExact) {
  const MapCanvas b = random_map(2);
  const MapSnapshot merged = merge_maps(MapCanvas().map(), b.map(), {-71 * 0.02, 13 * 0.02, 0});
  for (int x = -100; x <= 100; ++x) {
    for (int y = -100; y <= 100; ++y) {
      for (int k = 0; k < 3; ++k)
        ASSERT_EQ(cell_in(merged, {x - 71, y + 13}, k), cell_in(b.map(), {x, y}, k));
    }
  }
}

TEST(MapMerge, AQuarterTurnIsExactToo) {
  const MapCanvas b = random_map(3);
  const MapSnapshot merged = merge_maps(MapCanvas().map(), b.map(), {0, 0, std::numbers::pi / 2});
  for (int x = -100; x <= 100; ++x) {
    for (int y = -100; y <= 100; ++y) ASSERT_EQ(cell_in(merged, {-1 - y, x}, 2), cell_in(b.map(), {x, y}, 2));
  }
}

TEST(MapMerge, AnyTurnKeepsAWallInItsPlace) {
  MapCanvas b;
  b.fill({0, 0}, {100, 60}, kFreeCell);
  b.fill({0, 30}, {100, 33}, kOccupiedCell);
  const MapPlacement placement{1.234, -0.777, 0.6};
  const MapSnapshot merged = merge_maps(MapCanvas().map(), b.map(), placement);
  for (double s = 0.05; s < 1.95; s += 0.01) {
    const double x = s, y = 31.5 * 0.02;  // along the middle of the wall
    const CellIndex cell = cell_at(b.map().info.grid, std::cos(0.6) * x - std::sin(0.6) * y + 1.234,
                                   std::sin(0.6) * x + std::cos(0.6) * y - 0.777);
    EXPECT_GE(mu_O(cell_in(merged, cell, 0)), 0.5F);
  }
}

TEST(MapMerge, RefusesMapsOfAnotherKind) {
  EXPECT_THROW(merge_maps(MapCanvas().map(), MapCanvas({0.05, {0, 1}}).map(), {}), std::runtime_error);
  EXPECT_THROW(merge_maps(MapCanvas().map(), MapCanvas({0.02, {0, 1}}).map(), {}), std::runtime_error);
}

}  // namespace
}  // namespace flogmap
