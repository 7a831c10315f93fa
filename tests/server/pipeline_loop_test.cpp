// Loops through the whole chain: frames in, corrected path and rebuilt map out.
#include <gtest/gtest.h>

#include "tests/server/mapped_path.hpp"
#include "tests/server/round_trip.hpp"

namespace flogmap {
namespace {

std::unique_ptr<MappedPath> map_round_trip(const std::map<std::int64_t, SE3>& poses, bool close_loops,
                                           int num_threads = 2, bool batch = true,
                                           const std::optional<HandLevel>& level = std::nullopt) {
  FrontEndOptions options;
  options.views.translation_m = 0.01;  // every frame is a view
  options.stereo.num_threads = num_threads;
  return map_path(std::make_unique<MemorySource>(round_trip().recorded), options,
                  GivenPoses(poses, SE3::Identity()), coarse_map(num_threads),
                  close_loops ? std::optional(LoopOptions{}) : std::nullopt, batch, level);
}

/// A tile that one map lacks is unseen in the other.
void expect_same_cells(const std::map<TileIndex, std::shared_ptr<const Tile>>& a,
                       const std::map<TileIndex, std::shared_ptr<const Tile>>& b) {
  for (const auto& [index, tile] : a) {
    const auto other = b.find(index);
    EXPECT_EQ(tile->cells,
              other == b.end() ? decltype(Tile::cells)(tile->cells.size()) : other->second->cells);
  }
}

void expect_same_path(const std::vector<TrajectoryEntry>& a, const std::vector<TrajectoryEntry>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].timestamp_ns, b[i].timestamp_ns);
    EXPECT_TRUE(a[i].world_from_camera.matrix() == b[i].world_from_camera.matrix()) << i;
  }
}

double end_error_m(const std::vector<TrajectoryEntry>& path) {
  return (path.back().world_from_camera.translation() - round_trip().truth.back().translation()).norm();
}

TEST(PipelineLoops, AClosedLoopTakesTheDriftOutOfPathAndMap) {
  const auto open = map_round_trip(round_trip().odometry, false);
  const auto closed = map_round_trip(round_trip().odometry, true);
  EXPECT_EQ(open->status.loops, 0U);
  EXPECT_GT(closed->status.loops, 0U);
  EXPECT_GT(closed->witness.rewrites, 0);
  EXPECT_EQ(closed->witness.path.size(), round_trip().truth.size());
  EXPECT_GT(end_error_m(open->witness.path), 0.04);
  EXPECT_LT(end_error_m(closed->witness.path), 0.5 * end_error_m(open->witness.path));
}

TEST(PipelineLoops, TheRebuiltMapIsTheOneMadeFromScratchWithTheFinalPoses) {
  const auto closed = map_round_trip(round_trip().odometry, true);
  ASSERT_GT(closed->status.loops, 0U);
  std::map<std::int64_t, SE3> final_poses;
  for (const TrajectoryEntry& entry : closed->witness.path) {
    EXPECT_TRUE(entry.mapped);
    final_poses[entry.timestamp_ns] = entry.world_from_camera;
  }
  const auto from_scratch = map_round_trip(final_poses, false);
  expect_same_path(closed->witness.path, from_scratch->witness.path);
  expect_same_cells(closed->map.tiles, from_scratch->map.tiles);
  expect_same_cells(from_scratch->map.tiles, closed->map.tiles);
}

TEST(PipelineLoops, NeitherThreadsNorTheMomentOfRebuildingChangeTheResult) {
  const auto one = map_round_trip(round_trip().odometry, true, 1);
  for (const auto& other : {map_round_trip(round_trip().odometry, true, 2),
                            map_round_trip(round_trip().odometry, true, 2, false)}) {
    expect_same_path(one->witness.path, other->witness.path);
    expect_same_cells(one->map.tiles, other->map.tiles);
    expect_same_cells(other->map.tiles, one->map.tiles);
    expect_same_cells(other->witness.tiles, one->map.tiles);
    expect_same_cells(one->map.tiles, other->witness.tiles);
  }
}

TEST(PipelineLoops, LevelledByHandPathAndMapAreThoseOfLevelledPoses) {
  const HandLevel level{.roll_rad = 0.05, .pitch_rad = 0.03, .yaw_rad = -1, .height_m = 0.2};
  const auto levelled = map_round_trip(round_trip().odometry, true, 2, false, level);
  ASSERT_GT(levelled->witness.levelled_by, 0U);
  EXPECT_EQ(levelled->witness.level, level);
  const auto before = map_round_trip(round_trip().odometry, true);
  std::map<std::int64_t, SE3> final_poses;
  ASSERT_EQ(levelled->witness.path.size(), before->witness.path.size());
  for (std::size_t i = 0; i < levelled->witness.path.size(); ++i) {
    const TrajectoryEntry& entry = levelled->witness.path[i];
    final_poses[entry.timestamp_ns] = entry.world_from_camera;
    EXPECT_TRUE(entry.world_from_camera.isApprox(
        level.map_from_start() * before->witness.path[i].world_from_camera, 1e-9));
  }
  const auto from_scratch = map_round_trip(final_poses, false);
  expect_same_cells(levelled->map.tiles, from_scratch->map.tiles);
  expect_same_cells(from_scratch->map.tiles, levelled->map.tiles);
  expect_same_cells(levelled->witness.tiles, levelled->map.tiles);  // viewers were told all of it
}

}  // namespace
}  // namespace flogmap
