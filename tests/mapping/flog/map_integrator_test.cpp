#include "mapping/flog/map_integrator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_planes.hpp"
#include "tests/support/box_scene.hpp"

namespace flogmap {
namespace {

using namespace test;

constexpr StereoCamera kCamera{180, 155.5, 99.5, 0.11, 312, 200};
constexpr double kMaxDisparity_px = 40;

FlogOptions options_with(IntegratorKind kind, int num_threads = 1) {
  FlogOptions options;
  options.integrator = kind;
  options.num_threads = num_threads;
  return options;
}

std::vector<View> views_of(const BoxScene& scene, int count, unsigned seed = 1) {
  std::vector<View> views;
  for (const SE3& pose : random_poses(seed, count, {-2.4, -2, 0.4}, {0.3, 0.8, 1.8})) {
    views.push_back(seen_from(scene, kCamera, pose));
  }
  return views;
}

MapSnapshot map_of(const std::vector<View>& views, const FlogOptions& options) {
  MapIntegrator integrator(options, kCamera, kMaxDisparity_px);
  for (const View& view : views) integrator.integrate(view);
  return integrator.snapshot();
}

void expect_same_cells(const MapSnapshot& a, const MapSnapshot& b) {
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (auto i = a.tiles.begin(), j = b.tiles.begin(); i != a.tiles.end(); ++i, ++j) {
    ASSERT_EQ(i->first, j->first);
    ASSERT_EQ(i->second->cells, j->second->cells);
  }
}

class EveryIntegrator : public ::testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Map, EveryIntegrator, ::testing::Values(IntegratorKind::fan, IntegratorKind::ray),
                         [](const auto& kind) { return kind.param == IntegratorKind::fan ? "Fan" : "Ray"; });

TEST_P(EveryIntegrator, EvidenceIsAPartOfOneAndUnseenCellsAreUntouched) {
  const MapSnapshot map = map_of(views_of(furnished_room(), 6), options_with(GetParam()));
  for (const auto& [index, tile] : map.tiles) {
    for (const Cell& cell : tile->cells) {
      ASSERT_LE(cell.empty + cell.occupied, 65535);
      if (cell.rays == 0) {
        ASSERT_EQ(cell, Cell{});
      }
    }
  }
}

TEST_P(EveryIntegrator, NothingIsTouchedBehindTheHitOrOutsideTheView) {
  const BoxScene room = furnished_room();
  const SE3 pose = looking({-2, 0, 1.1}, 0.3);
  const MapSnapshot map = map_of({seen_from(room, kCamera, pose)}, options_with(GetParam()));
  const double half_fov = std::atan(156.5 / 180), a = 0.02;
  const double m = 3 * kImageSigmaPx * std::sqrt(2.0) / (180 * 0.11) * 5 * 5 * 1.4;  // of the farthest hit
  for (const auto& [index, tile] : map.tiles) {
    for (std::size_t i = 0; i < tile->cells.size(); ++i) {
      if (tile->cells[i].rays == 0) continue;
      const int column = static_cast<int>(i % kTileColumns);
      const double x = ((index.x << 6) + (column & kTileMask) + 0.5) * a;
      const double y = ((index.y << 6) + (column >> kTileShift) + 0.5) * a;
      ASSERT_LT(x, 3 + m + a);
      ASSERT_LT(std::max(std::abs(y) - 2.5, -3 - x), m + a);
      const double azimuth = std::abs(std::remainder(std::atan2(y, x + 2) - 0.3, 2 * std::numbers::pi));
      const double away = std::hypot(x + 2, y);
      if (away > 2 * a) {
        ASSERT_LT(azimuth, half_fov + 1.5 * a / away);
      }
    }
  }
}

/// Largest mu_O, and largest M with full confidence, of layer 1 along row y near a wall that faces -x.
std::pair<float, float> best_of_row(const MapSnapshot& map, double wall_m, int y) {
  const double a = map.info.grid.cell_size_m;
  std::pair<float, float> best{0, 0};
  for (int x = static_cast<int>((wall_m - 0.3) / a) - 2; x <= (wall_m + 0.4) / a + 2; ++x) {
    const Cell cell = cell_in(map, {x, y}, 1);
    const float M = map_value(Operators::algebraic, mu_E(cell), mu_O(cell), 1);
    best = {std::max(best.first, mu_O(cell)), std::max(best.second, M)};
  }
  return best;
}

/// A camera like kCamera that only sees what is straight ahead, so that no ray leaves its row of cells
/// sideways.
constexpr StereoCamera kNarrow{180, 0, 5, 0.11, 1, 11};

TEST_P(EveryIntegrator, AWallStraightAheadLeavesACellHalfOccupiedWhereverItStands) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> distance_m(0.3, 4);
  for (const double a : {0.02, 0.05}) {
    FlogOptions options = options_with(GetParam());
    options.grid.cell_size_m = a;
    for (int trial = 0; trial < 200; ++trial) {
      const double wall_m = distance_m(random);
      MapIntegrator integrator(options, kNarrow, 1000);
      const BoxScene scene{{{-9, -9, -9}, {wall_m, 9, 9}}, {}};
      integrator.integrate(seen_from(scene, kNarrow, looking({0, a / 2, 1.1}, 0)));
      ASSERT_GE(best_of_row(integrator.snapshot(), wall_m, 0).first, 0.5F)
          << "wall at " << wall_m << " m, cell " << a << " m";
    }
  }
}

TEST_P(EveryIntegrator, AWallIsAnObstacleInEveryColumnAlsoSeenAskance) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> distance_m(0.3, 4);
  for (const double a : {0.02, 0.05}) {
    FlogOptions options = options_with(GetParam());
    options.grid.cell_size_m = a;
    for (int trial = 0; trial < 15; ++trial) {
      const double wall_m = distance_m(random);
      MapIntegrator integrator(options, kCamera, 1000);
      const BoxScene scene{{{-9, -9, -9}, {wall_m, 9, 9}}, {}};
      integrator.integrate(seen_from(scene, kCamera, looking({0, 0.003, 1.1}, 0)));
      const MapSnapshot map = integrator.snapshot();
      const int side = static_cast<int>(0.8 * wall_m * 155 / 180 / a);
      for (int y = -side; y <= side; ++y) {
        ASSERT_GE(best_of_row(map, wall_m, y).second, kObstacleThreshold)
            << "wall at " << wall_m << " m, cell " << a << " m, row " << y;
      }
    }
  }
}

TEST_P(EveryIntegrator, MovingTheWorldByWholeTilesMovesTheMapByThoseTiles) {
  const double a = 1.0 / 64;  // a tile is exactly 1 m, so the move is exact too
  FlogOptions options = options_with(GetParam());
  options.grid.cell_size_m = a;
  std::vector<View> views = views_of(furnished_room(), 3, 2);
  for (View& view : views) {  // places that binary fractions hold exactly, before and after
    view.world_from_camera.translation() =
        (view.world_from_camera.translation() * 1024).array().round() / 1024;
  }
  const MapSnapshot here = map_of(views, options);
  for (View& view : views) view.world_from_camera.translation() += Eigen::Vector3d(-5, 3, 0);
  const MapSnapshot there = map_of(views, options);
  ASSERT_EQ(here.tiles.size(), there.tiles.size());
  for (const auto& [index, tile] : here.tiles) {
    const auto moved = there.tiles.find({index.x - 5, index.y + 3});
    ASSERT_NE(moved, there.tiles.end());
    ASSERT_EQ(tile->cells, moved->second->cells);
  }
}

TEST_P(EveryIntegrator, TheOrderOfViewsDoesNotMatterBelowTheCap) {
  FlogOptions options = options_with(GetParam());
  options.full_confidence_rays = 65535;
  std::vector<View> views = views_of(furnished_room(), 5, 3);
  const MapSnapshot forth = map_of(views, options);
  std::reverse(views.begin(), views.end());
  const MapSnapshot back = map_of(views, options);
  ASSERT_EQ(forth.tiles.size(), back.tiles.size());
  for (const auto& [index, tile] : forth.tiles) {
    const Tile& other = *back.tiles.at(index);
    for (std::size_t i = 0; i < tile->cells.size(); ++i) {
      if (tile->cells[i].rays >= 65535) continue;  // a cell that holds the camera may reach it
      ASSERT_EQ(tile->cells[i].rays, other.cells[i].rays);
      ASSERT_NEAR(tile->cells[i].empty, other.cells[i].empty, 5);
      ASSERT_NEAR(tile->cells[i].occupied, other.cells[i].occupied, 5);
    }
  }
}

TEST_P(EveryIntegrator, ALongRayOnlySaysWhereItIsFree) {
  FlogOptions options = options_with(GetParam());
  options.max_range_m = 2;
  const BoxScene scene{{{-9, -9, -9}, {3.7, 9, 9}}, {}};
  const MapSnapshot map = map_of({seen_from(scene, kCamera, looking({0, 0, 1.1}, 0))}, options);
  bool any = false;
  for (const auto& [index, tile] : map.tiles) {
    for (const Cell& cell : tile->cells) {
      any = any || cell.rays > 0;
      ASSERT_EQ(cell.occupied, 0);
    }
  }
  EXPECT_TRUE(any);
  EXPECT_GT(cell_in(map, {98, 0}, 1).rays, 0);
  EXPECT_EQ(cell_in(map, {101, 0}, 1).rays, 0);
}

TEST(MapIntegrator, GivesTheSameBitsOnAnyNumberOfThreads) {
  const auto views = views_of(furnished_room(), 8, 4);
  const MapSnapshot one = map_of(views, options_with(IntegratorKind::fan, 1));
  for (const int threads : {2, 3, 7})
    expect_same_cells(one, map_of(views, options_with(IntegratorKind::fan, threads)));
}

TEST(MapIntegrator, RowStepsWithTheirOwnFullConfidenceGiveTheSameMap) {
  const auto views = views_of(furnished_room(), 8, 5);
  const MapSnapshot every = map_of(views, options_with(IntegratorKind::fan));
  for (const int step : {2, 4}) {
    FlogOptions options = options_with(IntegratorKind::fan);
    options.row_step = step;
    const MapSnapshot some = map_of(views, options);
    double sum = 0;
    int count = 0;
    for (const auto& [index, tile] : some.tiles) {
      const TilePlane M = value_plane(*tile, some.info, std::nullopt, {});
      const TilePlane expected = value_plane(*every.tiles.at(index), every.info, std::nullopt, {});
      for (std::size_t i = 0; i < M.size(); ++i) {
        if (M.pixels[i] == 0 && expected.pixels[i] == 0) continue;
        sum += std::abs(M.pixels[i] - expected.pixels[i]) / 255.0;
        ++count;
      }
    }
    EXPECT_LE(sum / count, 0.03) << "every " << step << "th row";
  }
}

TEST(MapIntegrator, MemoryIsThatOfTheTilesTouched) {
  const auto views = views_of(furnished_room(), 8, 6);
  const MapSnapshot map = map_of(views, options_with(IntegratorKind::fan));
  for (const auto& [index, tile] : map.tiles) {
    const auto seen = [](const Cell& cell) { return cell.rays > 0; };
    EXPECT_TRUE(std::any_of(tile->cells.begin(), tile->cells.end(), seen));
  }
  EXPECT_EQ(map_bytes(map), map.tiles.size() * 3 * 4096 * 8);
}

TEST(MapIntegrator, EveryChangedTileCarriesTheRevisionAndTheUpdatesMakeTheMap) {
  MapIntegrator integrator(options_with(IntegratorKind::fan), kCamera, kMaxDisparity_px);
  MapSnapshot applied;
  std::uint64_t revision = 0;
  for (const View& view : views_of(furnished_room(), 6, 7)) {
    const auto updates = integrator.integrate(view);
    revision += updates.empty() ? 0 : 1;
    EXPECT_EQ(integrator.revision(), revision);
    for (const TileUpdate& update : updates) {
      EXPECT_EQ(update.revision, revision);
      EXPECT_EQ(update.tile->revision, revision);
      applied.tiles[update.index] = update.tile;
    }
  }
  expect_same_cells(applied, integrator.snapshot());
}

TEST(MapIntegrator, WhatWasHandedOutNeverChanges) {
  const auto views = views_of(furnished_room(), 4, 8);
  MapIntegrator integrator(options_with(IntegratorKind::fan), kCamera, kMaxDisparity_px);
  integrator.integrate(views[0]);
  const MapSnapshot before = integrator.snapshot();
  const MapSnapshot copy = map_of({views[0]}, options_with(IntegratorKind::fan));
  for (const View& view : views) integrator.integrate(view);
  expect_same_cells(before, copy);
}

TEST(MapIntegrator, ViewsWithoutRaysChangeNothing) {
  MapIntegrator integrator(options_with(IntegratorKind::fan), kCamera, kMaxDisparity_px);
  View view = seen_from(furnished_room(), kCamera, looking({0, 0, 1}, 0));
  View blind = view, nowhere = view, far_out = view;
  for (float& d : blind.disparity.px.pixels) d = std::nanf("");
  nowhere.world_from_camera.translation().x() = std::nan("");
  far_out.world_from_camera.translation().x() = 1e12;
  View odd = view;
  for (std::size_t i = 0; i < odd.disparity.px.size(); ++i) {
    constexpr float kOdd[] = {0, -1, -INFINITY, INFINITY, 1e-30F};
    odd.disparity.px.pixels[i] = kOdd[i % 5];
  }
  for (const View& bad : {blind, nowhere, far_out, odd, View{}})
    EXPECT_TRUE(integrator.integrate(bad).empty());
  EXPECT_EQ(integrator.revision(), 0U);
  EXPECT_FALSE(integrator.integrate(view).empty());
}

TEST(MapIntegrator, GoesOnFromAStoredMapAsIfItHadNeverStopped) {
  const auto views = views_of(furnished_room(), 4, 9);
  const auto options = options_with(IntegratorKind::fan);
  MapIntegrator second(options, kCamera, kMaxDisparity_px);
  second.restore(map_of({views[0], views[1]}, options));
  EXPECT_EQ(second.revision(), 2U);
  second.integrate(views[2]);
  second.integrate(views[3]);
  expect_same_cells(second.snapshot(), map_of(views, options));
}

TEST(MapIntegrator, RefusesAStoredMapOfAnotherKind) {
  FlogOptions options;
  const MapSnapshot stored = map_of({}, options);
  options.grid.cell_size_m = 0.05;
  EXPECT_THROW(MapIntegrator(options, kCamera, 40).restore(stored), std::runtime_error);
  options = {};
  options.grid.layer_bounds_m = {0, 1};
  EXPECT_THROW(MapIntegrator(options, kCamera, 40).restore(stored), std::runtime_error);
}

TEST(MapIntegrator, ReplacingTheMapPublishesOnlyWhatDiffers) {
  const auto views = views_of(furnished_room(), 4, 10);
  const auto options = options_with(IntegratorKind::fan);
  MapIntegrator integrator(options, kCamera, kMaxDisparity_px);
  for (const View& view : views) integrator.integrate(view);
  EXPECT_TRUE(integrator.replace_by(map_of(views, options)).empty());
  const MapSnapshot before = integrator.snapshot(), rebuilt = map_of({views[0]}, options);
  const auto updates = integrator.replace_by(rebuilt);
  std::set<TileIndex> changed;
  for (const TileUpdate& update : updates) {
    changed.insert(update.index);
    EXPECT_EQ(update.revision, before.revision + 1);
    const auto wanted = rebuilt.tiles.find(update.index);
    const auto unseen = TileCells(3 * kTileColumns);
    EXPECT_EQ(update.tile->cells, wanted == rebuilt.tiles.end() ? unseen : wanted->second->cells);
  }
  for (const auto& [index, tile] : before.tiles) {
    const auto wanted = rebuilt.tiles.find(index);
    const bool same = wanted != rebuilt.tiles.end() && wanted->second->cells == tile->cells;
    EXPECT_EQ(changed.contains(index), !same);
  }
}

/// Views of `after` that it takes, once `before` was seen 20 times, until the class of a column changes.
int views_until_changed(const BoxScene& before, const BoxScene& after, CellClass first, CellClass then) {
  const SE3 pose = looking({-2.3, 1.55, 0.6}, 0);
  const View old_view = seen_from(before, kCamera, pose), new_view = seen_from(after, kCamera, pose);
  MapIntegrator integrator(options_with(IntegratorKind::fan), kCamera, kMaxDisparity_px);
  for (int i = 0; i < 20; ++i) integrator.integrate(old_view);
  const CellIndex front = cell_at(integrator.info().grid, -1.19, 1.55);  // of the stool
  const auto now = [&] {
    return classify(Operators::algebraic, cell_in(integrator.snapshot(), front, 0), 8);
  };
  EXPECT_EQ(now(), first);
  integrator.integrate(new_view);
  EXPECT_GT(cell_in(integrator.snapshot(), front, 0).change, 20'000) << "the change is marked at once";
  int views = 1;
  for (; now() != then && views < 1000; ++views) integrator.integrate(new_view);
  return views;
}

TEST(MapIntegrator, ForgetsABoxThatIsTakenAwayAndSeesOneThatIsPutDown) {
  const BoxScene with = furnished_room();
  BoxScene without = with;
  without.boxes.erase(without.boxes.begin() + 3);  // the stool
  const int until_gone = views_until_changed(with, without, CellClass::occupied, CellClass::free);
  const int until_there = views_until_changed(without, with, CellClass::free, CellClass::occupied);
  RecordProperty("views_until_gone", until_gone);
  RecordProperty("views_until_there", until_there);
  EXPECT_LE(until_gone, 20);
  EXPECT_LE(until_there, 20);
}

TEST(FlogOptions, ImpossibleOnesAreRefused) {
  FlogOptions options;
  options.max_range_m = -1;
  EXPECT_THROW(check(options), std::invalid_argument);
  options = {};
  options.row_step = 0;
  EXPECT_THROW(check(options), std::invalid_argument);
  EXPECT_THROW(MapIntegrator({}, StereoCamera{}, 64), std::invalid_argument);
  EXPECT_THROW(MapIntegrator({}, kCamera, 0), std::invalid_argument);
}

}  // namespace
}  // namespace flogmap
