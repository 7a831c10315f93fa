#include "mapping/flog/grid_spec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace flogmap {
namespace {

TEST(GridSpec, TheMiddleOfEveryColumnLiesInThatColumn) {
  const GridSpec grid;
  for (const int i : {-1'000'000, -65, -64, -63, -1, 0, 1, 63, 64, 1'000'000}) {
    const double middle = cell_middle_m(grid, i);
    EXPECT_EQ(cell_at(grid, middle, -middle).x, i);
    EXPECT_EQ(cell_at(grid, -middle, middle).y, i);
  }
}

TEST(GridSpec, APointLiesInsideItsColumn) {
  const GridSpec grid;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place_m(-100, 100);
  for (int i = 0; i < 10'000; ++i) {
    const double x = place_m(random), y = place_m(random);
    const CellIndex cell = cell_at(grid, x, y);
    EXPECT_LE(std::abs(cell_middle_m(grid, cell.x) - x), grid.cell_size_m / 2 + 1e-12);
    EXPECT_LE(std::abs(cell_middle_m(grid, cell.y) - y), grid.cell_size_m / 2 + 1e-12);
  }
}

TEST(GridSpec, TileAndPlaceGiveTheColumnBack) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> index(-100'000, 100'000);
  for (int i = 0; i < 10'000; ++i) {
    const CellIndex cell{index(random), index(random)};
    const CellIndex first = first_cell(tile_of(cell));
    const int place = column_in_tile(cell);
    EXPECT_EQ(first.x + (place & kTileMask), cell.x);
    EXPECT_EQ(first.y + (place >> kTileShift), cell.y);
  }
}

std::string complaint(const GridSpec& grid) {
  try {
    check(grid);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(GridSpec, AnImpossibleOneIsNamed) {
  EXPECT_EQ(complaint(GridSpec{}), "");
  EXPECT_THAT(complaint({0, {0, 1}}), ::testing::HasSubstr("cell_size_m"));
  EXPECT_THAT(complaint({0.02, {0}}), ::testing::HasSubstr("layer_bounds_m"));
  EXPECT_THAT(complaint({0.02, {0, 1, 1}}), ::testing::HasSubstr("place 2"));
  EXPECT_THAT(complaint({0.02, {0, std::nan("")}}), ::testing::HasSubstr("nan"));
}

}  // namespace
}  // namespace flogmap
