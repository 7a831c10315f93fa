#include "mapping/map_builder.hpp"

#include <gtest/gtest.h>

#include <random>

#include "mapping/loop/view_store.hpp"
#include "tests/support/same_cells.hpp"

namespace flogmap {
namespace {

const StereoCamera kCamera{
    .focal_px = 60, .cx_px = 39.5, .cy_px = 29.5, .baseline_m = 0.1, .width_px = 80, .height_px = 60};
constexpr std::int64_t kStep_ns = 100;

MapIntegrator empty_map(int num_threads = 1) {
  FlogOptions options;
  options.grid.cell_size_m = 0.05;
  options.num_threads = num_threads;
  return {options, kCamera, 64};
}

/// Looking along the world's x axis from 1 m above the floor, then moved.
SE3 pose_at(double x_m, double y_m, double yaw_rad) {
  SE3 pose = SE3::Identity();
  Eigen::Matrix3d world_from_level;
  world_from_level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * world_from_level;
  pose.translation() = Eigen::Vector3d(x_m, y_m, 1);
  return pose;
}

/// Views of random surfaces along a way, all but the last `num_later` in segment 0, those in segment 1.
std::vector<View> random_views(int count, int num_later) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    View view;
    view.timestamp_ns = i * kStep_ns;
    view.world_from_camera = pose_at(0.1 * i, 0.3 * uniform(random), uniform(random));
    view.disparity.px = Image<float>(kCamera.width_px, kCamera.height_px);
    const double tilt = 0.1 * uniform(random);
    for (int y = 0; y < kCamera.height_px; ++y) {
      for (int x = 0; x < kCamera.width_px; ++x) {
        view.disparity.px.at(x, y) = static_cast<float>(2 + tilt * x + 0.3 * uniform(random));
      }
    }
    view.segment = i >= count - num_later ? 1 : 0;
    views.push_back(std::move(view));
  }
  return views;
}

PathCorrection correction_until(const std::vector<View>& views, std::size_t count, double shift_m) {
  std::vector<CorrectionKnot> knots;
  for (std::size_t i = 0; i < count; ++i) {
    SE3 moved = SE3::Identity();
    moved.translation() = Eigen::Vector3d(shift_m * static_cast<double>(i), -0.5 * shift_m, 0);
    moved.linear() =
        Eigen::AngleAxisd(0.01 * static_cast<double>(i), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    knots.push_back({views[i].timestamp_ns, views[i].segment, moved});
  }
  return PathCorrection(std::move(knots));
}

/// The map that these views give with their final poses.
MapSnapshot from_scratch(std::vector<View> views, const PathCorrection& correction) {
  MapIntegrator map = empty_map();
  for (View& view : views) {
    const auto map_from_odometry = correction.map_from_odometry(view.timestamp_ns, view.segment);
    if (!map_from_odometry) continue;
    view.world_from_camera = *map_from_odometry * view.world_from_camera;
    round_disparity(view.disparity);
    map.integrate(view);
  }
  return map.snapshot();
}

/// What a viewer holds who applies every update.
void take_in(MapSnapshot& viewer, const std::vector<TileUpdate>& updates) {
  for (const TileUpdate& update : updates) viewer.tiles[update.index] = update.tile;
}

TEST(MapBuilder, ARebuiltMapIsTheOneMadeFromScratchWithTheFinalPoses) {
  std::vector<View> views = random_views(14, 0);
  const PathCorrection early = correction_until(views, 5, 0.02), late = correction_until(views, 9, -0.03);
  for (const int num_threads : {1, 3}) {
    MapBuilder builder(empty_map(num_threads), {});
    MapSnapshot viewer;
    for (std::size_t i = 0; i < views.size(); ++i) {
      View view = views[i];
      take_in(viewer, builder.add(view));
      if (i == 6) builder.correct(early);
      if (i >= 6 && i % 2 == 0) take_in(viewer, builder.catch_up());  // a slice now and then
      if (i == 10) builder.correct(late);                             // while the first rebuild goes on
    }
    EXPECT_TRUE(builder.is_behind());
    while (builder.is_behind()) take_in(viewer, builder.catch_up());
    expect_same_cells(builder.map().snapshot(), from_scratch(views, late));
    expect_same_cells(builder.map().snapshot(), viewer);
  }
}

TEST(MapBuilder, WithoutCorrectionsItIsTheIntegratorOfRoundedViews) {
  const std::vector<View> views = random_views(6, 0);
  MapBuilder builder(empty_map(), {.keep_views = false});
  for (View view : views) builder.add(view);
  EXPECT_FALSE(builder.is_behind());
  expect_same_cells(builder.map().snapshot(), from_scratch(views, {}));
}

TEST(MapBuilder, ViewsWithoutAPlaceWaitAndAreDrawnWhenTheirSegmentIsJoined) {
  const std::vector<View> views = random_views(10, 4);
  MapBuilder builder(empty_map(), {});
  for (View view : views) builder.add(view);
  EXPECT_EQ(builder.num_waiting(), 4U);
  expect_same_cells(builder.map().snapshot(), from_scratch(views, {}));
  const PathCorrection joined = correction_until(views, 10, 0.01);
  builder.correct(joined);
  EXPECT_EQ(builder.num_waiting(), 0U);
  while (builder.is_behind()) builder.catch_up();
  expect_same_cells(builder.map().snapshot(), from_scratch(views, joined));
}

TEST(MapBuilder, ViewsThatAreNoLongerKeptStayWhereTheyWere) {
  std::vector<View> views = random_views(12, 0);
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < 5; ++i) bytes += pack_disparity(views[views.size() - 1 - i].disparity).size();
  MapBuilder builder(empty_map(), {.keep_views = true, .max_view_bytes = bytes});
  for (View view : views) builder.add(view);
  const PathCorrection correction = correction_until(views, 12, 0.02);
  builder.correct(correction);
  while (builder.is_behind()) builder.catch_up();
  MapIntegrator expected = empty_map();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const bool kept = i + 5 >= views.size();
    if (kept)
      views[i].world_from_camera =
          *correction.map_from_odometry(views[i].timestamp_ns, 0) * views[i].world_from_camera;
    round_disparity(views[i].disparity);
    expected.integrate(views[i]);
  }
  expect_same_cells(builder.map().snapshot(), expected.snapshot());
}

TEST(MapBuilder, AnEarlierMapStaysUnderWhatIsBuiltAnew) {
  const std::vector<View> views = random_views(8, 0);
  MapIntegrator earlier = empty_map();
  View far_off = views[0];
  far_off.world_from_camera.translation().y() += 30;
  round_disparity(far_off.disparity);
  earlier.integrate(far_off);
  MapBuilder builder(earlier, {});
  for (View view : views) builder.add(view);
  const PathCorrection correction = correction_until(views, 8, 0.02);
  builder.correct(correction);
  while (builder.is_behind()) builder.catch_up();
  MapSnapshot expected = from_scratch(views, correction);
  for (const auto& [index, tile] : earlier.snapshot().tiles) expected.tiles[index] = tile;
  expect_same_cells(builder.map().snapshot(), expected);
}

TEST(MapBuilder, AfterAResetNothingOfBeforeComesBack) {
  const std::vector<View> views = random_views(6, 2);
  MapBuilder builder(empty_map(), {});
  for (View view : views) builder.add(view);
  builder.correct(correction_until(views, 6, 0.02));
  builder.catch_up();
  builder.reset();
  EXPECT_FALSE(builder.is_behind());
  EXPECT_EQ(builder.num_waiting(), 0U);
  EXPECT_TRUE(builder.map().snapshot().tiles.empty());
  View view = views[0];
  builder.add(view);
  expect_same_cells(builder.map().snapshot(), from_scratch({views[0]}, {}));
}

const HandLevel kLevel{.roll_rad = 0.06, .pitch_rad = -0.1, .yaw_rad = 0.8, .height_m = -0.15};

/// Views as if the camera had begun like this.
std::vector<View> begun_at(const HandLevel& level, std::vector<View> views) {
  for (View& view : views) view.world_from_camera = level.map_from_start() * view.world_from_camera;
  return views;
}

void catch_up_whole(MapBuilder& builder) {
  while (builder.is_behind()) builder.catch_up();
}

TEST(MapBuilder, LevelledByHandItIsTheMapOfAFirstPoseThatIsSo) {
  const std::vector<View> views = random_views(10, 0);
  MapBuilder builder(empty_map(), {});
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i == 6) builder.correct(PathCorrection().levelled(kLevel));  // later views come levelled at once
    View view = views[i];
    builder.add(view);
  }
  catch_up_whole(builder);
  expect_same_cells(builder.map().snapshot(), from_scratch(begun_at(kLevel, views), {}));
}

TEST(MapBuilder, LevelledBackItIsTheFirstMapAgain) {
  const std::vector<View> views = random_views(8, 0);
  MapBuilder builder(empty_map(), {});
  for (View view : views) builder.add(view);
  const MapSnapshot first = builder.map().snapshot();
  builder.correct(PathCorrection().levelled(kLevel));
  catch_up_whole(builder);
  int differing = 0;
  for (const auto& [index, tile] : first.tiles)
    differing += builder.map().snapshot().tiles.at(index)->cells != tile->cells;
  EXPECT_GT(differing, 0);
  builder.correct(PathCorrection().levelled({}));
  catch_up_whole(builder);
  expect_same_cells(builder.map().snapshot(), first);
}

TEST(MapBuilder, AClosedLoopAndALevelAddUp) {
  const std::vector<View> views = random_views(9, 0);
  const PathCorrection loop = correction_until(views, 9, 0.02);
  MapBuilder builder(empty_map(), {});
  for (View view : views) builder.add(view);
  builder.correct(loop.levelled(kLevel));
  catch_up_whole(builder);
  std::vector<View> placed = views;
  for (View& view : placed) {
    view.world_from_camera = *loop.map_from_odometry(view.timestamp_ns, 0) * view.world_from_camera;
  }
  // The order of the products differs: a ray in ten thousand may end in the next cell.
  const MapSnapshot expected = from_scratch(begun_at(kLevel, placed), {});
  std::int64_t cells = 0, differing = 0;
  for (const auto& [index, tile] : expected.tiles) {
    const auto& mine = builder.map().snapshot().tiles.at(index)->cells;
    for (std::size_t i = 0; i < mine.size(); ++i) {
      cells += tile->cells[i].rays > 0;
      differing += mine[i] != tile->cells[i];
    }
  }
  EXPECT_GT(cells, 1000);
  EXPECT_LT(differing * 100, cells);
}

TEST(MapBuilder, OnlyAMapWhoseViewsAreAllKeptIsWhole) {
  const std::vector<View> views = random_views(6, 0);
  MapBuilder kept(empty_map(), {}), without(empty_map(), {.keep_views = false});
  MapBuilder full(empty_map(), {.keep_views = true, .max_view_bytes = 1});
  for (MapBuilder* builder : {&kept, &without, &full}) {
    for (View view : views) builder->add(view);
  }
  EXPECT_TRUE(kept.is_whole());
  EXPECT_FALSE(without.is_whole());
  EXPECT_FALSE(full.is_whole());
  full.reset();
  EXPECT_TRUE(full.is_whole());
  MapIntegrator earlier = empty_map();
  earlier.restore(kept.map().snapshot());
  EXPECT_FALSE(MapBuilder(std::move(earlier), {}).is_whole());
}

}  // namespace
}  // namespace flogmap
