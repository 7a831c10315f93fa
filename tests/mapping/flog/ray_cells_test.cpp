#include "mapping/flog/ray_cells.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>
#include <vector>

namespace flogmap {
namespace {

using CellKey = std::tuple<int, int, int>;

CellKey key(const Chord& chord) { return {chord.column.x, chord.column.y, chord.layer}; }

std::vector<Chord> chords_of(const GridSpec& grid, const Ray& ray) {
  std::vector<Chord> chords;
  for_each_cell(grid, ray, [&](const Chord& chord) { chords.push_back(chord); });
  return chords;
}

const GridSpec kGrid{0.1, {-0.5, 0.1, 0.2, 1.3}};

std::vector<Ray> random_rays(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place_m(-2, 2), length_m(0.01, 4);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d direction(normal(random), normal(random), normal(random) * (i % 3 ? 1 : 0.1));
    rays.push_back(
        {{place_m(random), place_m(random), place_m(random)}, direction.normalized(), length_m(random)});
  }
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    rays.push_back({{0.05, -0.03, 0.6}, axis, 3});
    rays.push_back({{0.1, 0.3, 0.1}, axis, 3});  // starts on edges
  }
  return rays;
}

/// Distances between which the ray is inside the box of a cell: slabs, without any walk.
std::pair<double, double> box_chord(const GridSpec& grid, const Ray& ray, int x, int y, int k) {
  const Eigen::Vector3d low(x * grid.cell_size_m, y * grid.cell_size_m, grid.layer_bounds_m[k]);
  const Eigen::Vector3d high((x + 1) * grid.cell_size_m, (y + 1) * grid.cell_size_m,
                             grid.layer_bounds_m[k + 1]);
  double begin = 0, end = ray.length_m;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = low[axis] - ray.origin[axis], to = high[axis] - ray.origin[axis];
    if (ray.direction[axis] == 0) {
      if (from > 0 || to <= 0) return {0, 0};
      continue;
    }
    const double t0 = from / ray.direction[axis], t1 = to / ray.direction[axis];
    begin = std::max(begin, std::min(t0, t1));
    end = std::min(end, std::max(t0, t1));
  }
  return {begin, end};
}

TEST(RayCells, EqualBruteForceBoxes) {
  for (const Ray& ray : random_rays(1, 60)) {
    std::set<CellKey> expected;
    for (int x = -65; x < 65; ++x) {
      for (int y = -65; y < 65; ++y) {
        for (int k = 0; k < kGrid.num_layers(); ++k) {
          const auto [begin, end] = box_chord(kGrid, ray, x, y, k);
          if (end - begin > 1e-9) expected.insert({x, y, k});
        }
      }
    }
    std::set<CellKey> walked;
    for (const Chord& chord : chords_of(kGrid, ray)) {
      if (chord.end_m - chord.begin_m > 1e-9) walked.insert(key(chord));
      const auto [begin, end] = box_chord(kGrid, ray, chord.column.x, chord.column.y, chord.layer);
      EXPECT_NEAR(chord.begin_m, begin, 1e-9);
      EXPECT_NEAR(chord.end_m, end, 1e-9);
    }
    EXPECT_EQ(walked, expected);
  }
}

TEST(RayCells, VisitNoCellTwiceAndJoinWithoutAGap) {
  for (const Ray& ray : random_rays(2, 2000)) {
    const auto chords = chords_of(kGrid, ray);
    std::set<CellKey> seen;
    for (std::size_t i = 0; i < chords.size(); ++i) {
      EXPECT_TRUE(seen.insert(key(chords[i])).second);
      EXPECT_LT(chords[i].begin_m, chords[i].end_m);
      if (i > 0) {
        EXPECT_EQ(chords[i].begin_m, chords[i - 1].end_m);
      }
    }
  }
}

TEST(RayCells, ChordsSumToTheLengthInsideTheLayers) {
  for (const Ray& ray : random_rays(3, 2000)) {
    double sum = 0;
    for (const Chord& chord : chords_of(kGrid, ray)) sum += chord.end_m - chord.begin_m;
    const auto [begin, end] = detail::clip_to_layers(kGrid, ray);
    EXPECT_NEAR(sum, std::max(0.0, end - begin), 1e-9);
  }
}

TEST(RayCells, TheReversedRayVisitsTheSameCells) {
  for (const Ray& ray : random_rays(4, 2000)) {
    const Ray back{ray.origin + ray.direction * ray.length_m, -ray.direction, ray.length_m};
    std::set<CellKey> forth_cells, back_cells;
    for (const Chord& chord : chords_of(kGrid, ray)) {
      if (chord.end_m - chord.begin_m > 1e-9) forth_cells.insert(key(chord));
    }
    for (const Chord& chord : chords_of(kGrid, back)) {
      if (chord.end_m - chord.begin_m > 1e-9) back_cells.insert(key(chord));
    }
    EXPECT_EQ(forth_cells, back_cells);
  }
}

TEST(RayCells, TheNearestPointIsOnTheChordAndNoSampleIsNearerToTheAxis) {
  for (const Ray& ray : random_rays(5, 300)) {
    for (const Chord& chord : chords_of(kGrid, ray)) {
      const Eigen::Vector2d axis(cell_middle_m(kGrid, chord.column.x), cell_middle_m(kGrid, chord.column.y));
      const auto away = [&](double r) { return ((ray.origin + ray.direction * r).head<2>() - axis).norm(); };
      EXPECT_GE(chord.nearest_m, chord.begin_m);
      EXPECT_LE(chord.nearest_m, chord.end_m);
      for (int i = 0; i <= 10; ++i) {
        const double r = chord.begin_m + (chord.end_m - chord.begin_m) * i / 10;
        EXPECT_LE(away(chord.nearest_m), away(r) + 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace flogmap
