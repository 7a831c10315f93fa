// Laws of planes, overviews and the board.
#include "server/tile_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "server/cell_inspection.hpp"
#include "server/served_map.hpp"

namespace flogmap {
namespace {

constexpr float kN_K = 40;

MapInfo two_layers() {
  MapInfo info;
  info.grid.layer_bounds_m = {0, 1, 2};
  info.full_confidence_rays = {kN_K, kN_K};
  return info;
}

Cell random_cell(std::mt19937& random) {
  std::uniform_int_distribution<int> evidence(0, 65535), rays(0, 80);
  const int E = evidence(random), O = std::uniform_int_distribution<int>(0, 65535 - E)(random),
            N = rays(random);
  if (N == 0) return {};
  return {static_cast<std::uint16_t>(E), static_cast<std::uint16_t>(O), static_cast<std::uint16_t>(N),
          static_cast<std::uint16_t>(evidence(random))};
}

std::shared_ptr<const Tile> random_tile(std::mt19937& random, std::uint64_t revision) {
  Tile tile{{}, revision};
  for (int i = 0; i < 2 * kTileColumns; ++i) tile.cells.push_back(random_cell(random));
  return std::make_shared<const Tile>(std::move(tile));
}

TEST(Planes, DeflatingAndInflatingGivesThemBack) {
  std::mt19937 random(1);
  const auto tile = random_tile(random, 1);
  const PlaneBytes planes = evidence_planes(*tile, 1, kN_K);
  EXPECT_EQ(inflate_planes(deflate_planes(planes), planes.size()), planes);
  EXPECT_TRUE(inflate_planes("garbage", planes.size()).empty());
  EXPECT_TRUE(inflate_planes(deflate_planes(planes), planes.size() - 1).empty());
}

TEST(Planes, BytesAreTheRoundedValues) {
  std::mt19937 random(2);
  const auto tile = random_tile(random, 1);
  const PlaneBytes planes = evidence_planes(*tile, 0, kN_K),
                   M = value_plane(*tile, 0, kN_K, Operators::algebraic);
  for (int i = 0; i < kTileColumns; ++i) {
    const Cell& cell = tile->cells[i];
    const float K = confidence(cell, kN_K);
    EXPECT_EQ(planes[i], std::lround(255.0F * mu_E(cell)));
    EXPECT_EQ(planes[kTileColumns + i], std::lround(255.0F * mu_O(cell)));
    EXPECT_EQ(planes[2 * kTileColumns + i], std::lround(255.0F * K));
    const float expected = cell.rays == 0 ? 0 : map_value(Operators::algebraic, mu_E(cell), mu_O(cell), K);
    EXPECT_EQ(M[i], std::lround(255.0F * expected));
  }
}

TEST(Overview, NeitherPlanningNorMotionHidesADanger) {
  std::mt19937 random(3);
  // With the algebraic operators M_m falls a little with O where E K < 0.5; there it is above 0.75 anyway.
  constexpr float kSurelyDanger = 0.75F;
  constexpr float kStep = 2.0F / 65535;
  for (int trial = 0; trial < 20000; ++trial) {
    const std::array<Cell, 4> cells{random_cell(random), random_cell(random), random_cell(random),
                                    random_cell(random)};
    const Cell over = overview_cell(cells, kN_K);
    const float E = mu_E(over), O = mu_O(over), K = confidence(over, kN_K);
    EXPECT_LE(E + O, 1 + kStep);
    for (const auto operators : {Operators::algebraic, Operators::minmax, Operators::lukasiewicz}) {
      for (const Cell& cell : cells) {
        const float K_i = confidence(cell, kN_K);
        const float below = motion_value(operators, mu_E(cell), mu_O(cell), K_i);
        EXPECT_GE(motion_value(operators, E, O, K) + 1e-4F, std::min(below, kSurelyDanger));
        if (operators != Operators::algebraic) continue;
        EXPECT_GE(O * K + kStep, mu_O(cell) * K_i);
      }
    }
  }
}

TEST(Overview, AnUnseenQuarterMakesTheCellNotFree) {
  const Cell free{65535, 0, 80, 0};
  EXPECT_EQ(overview_cell({free, free, free, free}, kN_K),
            (Cell{65535, 0, static_cast<std::uint16_t>(kN_K), 0}));
  EXPECT_EQ(overview_cell({free, free, free, Cell{}}, kN_K).empty, 0);
  EXPECT_EQ(overview_cell({}, kN_K), Cell{});
}

TEST(TileBoard, ValuesOfAnOverviewAreTheMaximumBelow) {
  std::mt19937 random(4);
  TileBoard board(two_layers(), Operators::algebraic);
  board.update({{{-2, 0}, 1, random_tile(random, 1)}, {{-1, 1}, 1, random_tile(random, 1)}});
  const Slot parent = board.find({1, -1, 0}).value();
  const PlaneBytes over = board.value(parent, 1);
  for (int child = 0; child < 4; ++child) {
    const auto slot = board.find(child_of({1, -1, 0}, child));
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const std::uint8_t at = over[(y + 32 * (child >> 1)) * 64 + x + 32 * (child & 1)];
        if (!slot) {
          ASSERT_EQ(at, 0);
          continue;
        }
        const PlaneBytes below = board.value(*slot, 1);
        const std::size_t i = 2 * y * 64 + 2 * x;
        ASSERT_EQ(at, std::max({below[i], below[i + 1], below[i + 64], below[i + 65]}));
      }
      if (slot && y > 2) break;  // three rows of each child are enough
    }
  }
}

TEST(TileBoard, AChangeReachesEveryLevelOnceAndNoOther) {
  std::mt19937 random(5);
  TileBoard board(two_layers(), Operators::algebraic);
  board.update({{{0, 0}, 1, random_tile(random, 1)}, {{40, 40}, 1, random_tile(random, 1)}});
  const auto changed = board.update({{{0, 0}, 2, random_tile(random, 2)}});
  EXPECT_EQ(changed.size(), static_cast<std::size_t>(kOverviewLevels));
  for (const Slot slot : changed) EXPECT_EQ(board.revision(slot), 2U);
  for (std::uint32_t level = 0; level < kOverviewLevels; ++level) {
    const int far = 40 >> level;
    EXPECT_EQ(board.revision(board.find({level, far, far}).value()), 1U);
  }
}

TEST(TileBoard, OldNewsIsIgnoredAndRemovalsGoUp) {
  std::mt19937 random(6);
  TileBoard board(two_layers(), Operators::algebraic);
  board.update({{{3, 3}, 5, random_tile(random, 5)}});
  EXPECT_TRUE(board.update({{{3, 3}, 5, random_tile(random, 5)}, {{3, 3}, 4, nullptr}}).empty());
  EXPECT_EQ(board.update({{{3, 3}, 6, nullptr}}).size(), static_cast<std::size_t>(kOverviewLevels));
  EXPECT_FALSE(board.exists(board.find({0, 3, 3}).value()));
  EXPECT_FALSE(board.exists(board.find({5, 0, 0}).value()));
  EXPECT_FALSE(board.bounds());
}

TEST(TileBoard, BytesAreSharedUntilTheTileChanges) {
  std::mt19937 random(7);
  MapBegin begin;
  begin.info = two_layers();
  ServedMap map("live", std::move(begin), Operators::algebraic);
  map.update(1, {{{0, 0}, 1, random_tile(random, 1)}});
  const std::vector<Slot> slots{0, 1};
  const TileChoice choice{{1}, Planes::evidence};
  const Bytes first = map.tile_batch(1, true, slots, choice);
  EXPECT_EQ(map.tile_batch(1, true, slots, choice), first);
  map.update(2, {{{0, 0}, 2, random_tile(random, 2)}});
  EXPECT_NE(map.tile_batch(1, true, slots, choice), first);
}

TEST(Inspector, TellsWhatTheTileHolds) {
  std::mt19937 random(8);
  MapBegin begin;
  begin.info = two_layers();
  ServedMap map("live", std::move(begin), Operators::minmax);
  const auto tile = random_tile(random, 3);
  map.update(3, {{{-1, 0}, 3, tile}});
  const CellColumn column = inspect_cell(map, -0.01, 0.03);  // cell (-1, 1): column 63 of row 1
  const Cell& cell = tile->cells[kTileColumns + kTileSide + 63];
  ASSERT_EQ(column.layers.size(), 2U);
  EXPECT_EQ(column.revision, 3U);
  EXPECT_EQ(column.layers[1].rays, cell.rays);
  EXPECT_FLOAT_EQ(static_cast<float>(column.layers[1].empty), mu_E(cell));
  const CellColumn nowhere = inspect_cell(map, 500, 500);
  EXPECT_EQ(nowhere.revision, 0U);
  EXPECT_EQ(nowhere.layers[0].motion, 1);
  EXPECT_EQ(nowhere.layers[0].value, 0);
}

}  // namespace
}  // namespace flogmap
