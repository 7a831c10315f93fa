// The fan against the reference: FLOG.md section 7.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "mapping/flog/map_integrator.hpp"
#include "tests/support/box_scene.hpp"

namespace flogmap {
namespace {

using namespace test;

struct Difference {
  double cells = 0, E = 0, O = 0, far_off = 0;
  // Cells with 100 rays or more, the sum of their relative differences, and those off by more than 5 %.
  double counted = 0, count_off = 0, badly_counted = 0;
  double rays = 0, reference_rays = 0;
};

void compare(const Tile* fan, const Tile* reference, Difference& d) {
  const TileCells none((fan ? fan : reference)->cells.size());
  const TileCells& a = fan ? fan->cells : none;
  const TileCells& b = reference ? reference->cells : none;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].rays == 0 && b[i].rays == 0) continue;
    const double dE = std::abs(mu_E(a[i]) - mu_E(b[i])), dO = std::abs(mu_O(a[i]) - mu_O(b[i]));
    ++d.cells;
    d.E += dE;
    d.O += dO;
    if (dE > 0.1 || dO > 0.1) ++d.far_off;
    d.rays += a[i].rays;
    d.reference_rays += b[i].rays;
    if (b[i].rays >= 100) {
      ++d.counted;
      const double off = std::abs(double{1} * a[i].rays - b[i].rays) / b[i].rays;
      d.count_off += off;
      if (off > 0.05) ++d.badly_counted;
    }
  }
}

void compare(const View& view, const StereoCamera& camera, FlogOptions options, Difference& d) {
  options.integrator = IntegratorKind::fan;
  MapIntegrator fan(options, camera, 100);
  options.integrator = IntegratorKind::ray;
  MapIntegrator reference(options, camera, 100);
  fan.integrate(view);
  reference.integrate(view);
  const MapSnapshot a = fan.snapshot(), b = reference.snapshot();
  std::map<TileIndex, std::pair<const Tile*, const Tile*>> pairs;
  for (const auto& [index, tile] : a.tiles) pairs[index].first = tile.get();
  for (const auto& [index, tile] : b.tiles) pairs[index].second = tile.get();
  for (const auto& [index, pair] : pairs) compare(pair.first, pair.second, d);
}

void expect_close(const Difference& d) {
  ASSERT_GT(d.cells, 10'000);
  EXPECT_LE(d.E / d.cells, 0.003);
  EXPECT_LE(d.O / d.cells, 0.003);
  EXPECT_LE(d.far_off / d.cells, 0.001);
  EXPECT_LE(d.count_off / d.counted, 0.01);
  EXPECT_LE(d.badly_counted / d.counted, 0.015);
  EXPECT_NEAR(d.rays / d.reference_rays, 1, 0.001);
}

constexpr StereoCamera kCamera{435, 375.5, 239.5, 0.11, 752, 480};

TEST(Fan, EqualsTheReferenceInAFurnishedRoomForAnyPose) {
  Difference d;
  for (const SE3& pose : random_poses(11, 25, {-2.4, -2, 0.4}, {0.3, 0.8, 1.8})) {
    compare(seen_from(furnished_room(), kCamera, pose), kCamera, {}, d);
  }
  expect_close(d);
}

TEST(Fan, EqualsTheReferenceInAHallForAnyPose) {
  Difference d;
  for (const SE3& pose : random_poses(12, 25, {-2, -3, 0.3}, {2, -0.8, 1.8})) {
    compare(seen_from(two_boxes_in_a_hall(), kCamera, pose), kCamera, {}, d);
  }
  expect_close(d);
}

TEST(Fan, EqualsTheReferenceFromOutsideTheLayers) {
  Difference d;
  FlogOptions options;
  options.grid.layer_bounds_m = {0.05, 0.4, 0.5, 1.1};  // of different heights
  for (const SE3& pose : random_poses(13, 6, {-2, -2, 1.6}, {2, 2, 2.5})) {
    compare(seen_from(furnished_room(), kCamera, pose), kCamera, options, d);
  }
  expect_close(d);
}

TEST(Fan, EqualsTheReferenceInPaperModeWithStepsAndLargeCells) {
  Difference d;
  FlogOptions options;
  options.grid.cell_size_m = 0.05;
  options.paper_mode = true;
  options.row_step = 2;
  options.max_range_m = 3.5;
  for (const SE3& pose : random_poses(14, 8, {-2.4, -2, 0.4}, {0.3, 0.8, 1.8})) {
    compare(seen_from(furnished_room(), kCamera, pose), kCamera, options, d);
  }
  expect_close(d);
}

TEST(Fan, OfALevelCameraIsTheReference) {
  Difference d;
  compare(seen_from(furnished_room(), kCamera, looking({-2.3, 0.1, 1.2}, 0.7)), kCamera, {}, d);
  EXPECT_LE(d.E / d.cells, 1e-4);
  EXPECT_LE(d.O / d.cells, 1e-4);
  EXPECT_LE(d.count_off / d.counted, 0.005);
}

}  // namespace
}  // namespace flogmap
