#include "mapping/flog/map_score.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/flog/map_canvas.hpp"

namespace flogmap {
namespace {

using test::kFreeCell;
using test::kOccupiedCell;
using test::MapCanvas;

/// A room of 100 x 80 cells inside walls of 5, at the world's origin.
TruthLayer room() {
  TruthLayer truth{Image<std::uint8_t>(110, 90, 255), -0.1, -0.1, 0.02};
  for (int y = 5; y < 85; ++y) {
    for (int x = 5; x < 105; ++x) truth.solid.at(x, y) = 0;
  }
  return truth;
}

MapCanvas true_map() {
  MapCanvas canvas;
  canvas.fill({-2, -2}, {102, 82}, kOccupiedCell);
  canvas.fill({0, 0}, {100, 80}, kFreeCell);
  return canvas;
}

ScoreOptions from_the_middle() {
  ScoreOptions options;
  options.path_m = {{1, 0.8}};
  return options;
}

TEST(MapScore, OfATrueMapIsPerfect) {
  const LayerScore score = score_layer(true_map().map(), 0, room(), from_the_middle());
  EXPECT_EQ(score.occupied.f1, 1);
  EXPECT_EQ(score.free.f1, 1);
  EXPECT_EQ(score.coverage, 1);
  EXPECT_EQ(score.wrongly_blocked, 0);
  EXPECT_EQ(score.wrongly_free, 0);
}

TEST(MapScore, AnEmptyMapCannotWin) {
  const LayerScore score = score_layer(MapCanvas().map(), 0, room(), from_the_middle());
  EXPECT_EQ(score.occupied.f1, 0);
  EXPECT_EQ(score.coverage, 0);
}

TEST(MapScore, ForgivesWallsWithinTheToleranceOnly) {
  for (const int off : {2, 4}) {
    MapCanvas canvas;
    canvas.fill({0, 0}, {100, 80}, kFreeCell);
    canvas.fill({off, 0}, {off + 1, 80}, kOccupiedCell);  // should be at -1
    const LayerScore score = score_layer(canvas.map(), 0, room(), from_the_middle());
    EXPECT_LT(score.occupied.precision, 0.06);  // only its ends are near other walls
    ScoreOptions wide = from_the_middle();
    wide.tolerance_cells = off + 1;
    EXPECT_EQ(score_layer(canvas.map(), 0, room(), wide).occupied.precision, 1);
  }
}

TEST(MapScore, CountsAnObstacleThatIsNotThereInsideAndOutside) {
  MapCanvas inside = true_map();
  inside.fill({50, 40}, {60, 50}, kOccupiedCell);
  const LayerScore score = score_layer(inside.map(), 0, room(), from_the_middle());
  EXPECT_NEAR(score.wrongly_blocked, 100.0 / 8000, 1e-9);
  EXPECT_LT(score.occupied.precision, 1);
  MapCanvas outside = true_map();
  outside.fill({200, 40}, {210, 50}, kOccupiedCell);  // beyond the truth's picture
  EXPECT_LT(score_layer(outside.map(), 0, room(), from_the_middle()).occupied.precision, 0.9);
}

TEST(MapScore, CountsAHoleInAWallThatWasSeen) {
  MapCanvas canvas = true_map();
  canvas.fill({-2, 30}, {0, 50}, kFreeCell);
  const LayerScore score = score_layer(canvas.map(), 0, room(), from_the_middle());
  EXPECT_GT(score.wrongly_free, 0.03);
  EXPECT_LT(score.occupied.recall, 1);
}

TEST(MapScore, CoverageIsTheKnownShareOfWhatThePathCanReach) {
  MapCanvas canvas;
  canvas.fill({0, 0}, {25, 80}, kFreeCell);
  EXPECT_NEAR(score_layer(canvas.map(), 0, room(), from_the_middle()).coverage, 0.25, 1e-9);
  TruthLayer divided = room();
  for (int y = 0; y < 90; ++y) divided.solid.at(30, y) = 255;  // x = 0.5 m
  ScoreOptions left;
  left.path_m = {{0.2, 0.8}};
  EXPECT_NEAR(score_layer(canvas.map(), 0, divided, left).coverage, 1, 1e-9);
}

TEST(MapScore, AsksForSurfacesThatCouldBeSeen) {
  MapCanvas canvas;
  canvas.fill({0, 0}, {50, 80}, kFreeCell);
  canvas.fill({-1, 0}, {0, 80}, kOccupiedCell);
  ScoreOptions options = from_the_middle();
  options.seen_surfaces = Image<std::uint8_t>(110, 90, 255);
  const double asked_for_all = score_layer(canvas.map(), 0, room(), options).occupied.recall;
  options.seen_surfaces = Image<std::uint8_t>(110, 90, 0);
  for (int y = 10; y < 80; ++y) options.seen_surfaces->at(5, y) = 255;
  EXPECT_LT(asked_for_all, 0.4);
  EXPECT_EQ(score_layer(canvas.map(), 0, room(), options).occupied.recall, 1);
}

}  // namespace
}  // namespace flogmap
