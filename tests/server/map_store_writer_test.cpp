// The store's own thread: nobody waits for it, nothing published is lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "server/store/store_writer.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

using std::chrono::milliseconds;

MapBegin begin_of(const StoredMap& map) {
  MapBegin begin;
  begin.epoch = map.epoch;
  begin.info = map.info;
  begin.camera = map.camera;
  begin.revision = map.revision;
  begin.tiles = map.tiles;
  begin.trajectory = map.trajectory;
  return begin;
}

TEST(StoreMailbox, HoldsOneEntryPerTileTheNewest) {
  StoreMailbox box;
  for (const std::uint64_t revision : {3, 9, 5}) {
    StoreMailbox later;
    later.tiles[{1, 2}] = random_tile({1, 2}, revision, 1, 1);
    box.merge(std::move(later));
  }
  ASSERT_EQ(box.tiles.size(), 1U);
  EXPECT_EQ(box.tiles.begin()->second.revision, 9U);
}

TEST(StoreMailbox, ANewMapReplacesWhatWasWaiting) {
  StoreMailbox box;
  box.tiles[{1, 2}] = random_tile({1, 2}, 1, 1, 1);
  box.new_poses.resize(3);
  StoreMailbox later;
  later.begin.emplace();
  box.merge(std::move(later));
  EXPECT_TRUE(box.tiles.empty());
  EXPECT_TRUE(box.new_poses.empty());
}

PathRewrite rewrite_of(std::uint64_t number, const std::vector<TrajectoryEntry>& path) {
  return {
      .number = number, .path = path, .level = {.yaw_rad = 0.1 * static_cast<double>(number)}, .reason = {}};
}

TEST(StoreMailbox, ARewrittenPathReplacesThePosesThatWereWaiting) {
  StoreMailbox box;
  box.new_poses.resize(3);
  StoreMailbox later;
  later.path = rewrite_of(1, std::vector<TrajectoryEntry>(7));
  later.new_poses.resize(2);
  box.merge(std::move(later));
  EXPECT_EQ(box.path->path.size(), 7U);
  EXPECT_EQ(box.new_poses.size(), 2U);
}

TEST(StoreWriter, StoresWhatWasPublished) {
  const TemporaryFolder folder;
  StoredMap map = random_map(1);
  {
    StoreWriter writer(MapStore(folder / "map.flog"), map.options_json, map.calibration_json);
    writer.begin(begin_of(map));
    for (std::uint32_t i = 0; i < 50; ++i) {
      map.revision = 100 + i;
      map.tiles[i % 9] = random_tile(map.tiles[i % 9].index, map.revision, 3, i);
      writer.publish({map.tiles[i % 9]});
      map.trajectory.push_back(random_pose(i, i));
      writer.append_trajectory({map.trajectory.back()});
      if (i == 20) {
        map.trajectory.resize(5);
        writer.rewrite_path(rewrite_of(1, map.trajectory));
        map.level = rewrite_of(1, {}).level;
        map.behind = true;  // nobody says that the tiles follow
      }
    }
    const StoreState state = writer.flush();
    EXPECT_TRUE(state.ok);
    EXPECT_EQ(state.committed_revision, map.revision);
    EXPECT_EQ(state.waiting_tiles, 0U);
    EXPECT_EQ(difference(load_map(folder / "map.flog"), map), "");
  }
  EXPECT_EQ(difference(load_map(folder / "map.flog"), map), "");
}

TEST(StoreWriter, CommitsOfItselfAndOnceMoreWhenItEnds) {
  const TemporaryFolder folder;
  StoredMap map = random_map(2);
  {
    StoreWriter writer(MapStore(folder / "map.flog"), map.options_json, map.calibration_json,
                       milliseconds(5));
    writer.begin(begin_of(map));
    for (int i = 0; i < 1000 && writer.state().commits == 0; ++i)
      std::this_thread::sleep_for(milliseconds(10));
    EXPECT_EQ(writer.state().committed_revision, map.revision);
    map.tiles[0] = random_tile(map.tiles[0].index, 70, 3, 3);
    map.revision = 70;
    writer.publish({map.tiles[0]});
  }
  EXPECT_EQ(difference(load_map(folder / "map.flog"), map), "");
}

TEST(StoreWriter, FromARewrittenPathUntilItsTilesAreThereTheStoreSaysThatTheyAreBehind) {
  const TemporaryFolder folder;
  const StoredMap map = random_map(4);
  StoreWriter writer(MapStore(folder / "map.flog"), "{}", "{}");
  const auto stored = [&] {
    EXPECT_TRUE(writer.flush().ok);
    return load_map(folder / "map.flog");
  };
  writer.begin(begin_of(map));
  EXPECT_FALSE(stored().behind);
  writer.rewrite_path(rewrite_of(1, map.trajectory));
  EXPECT_TRUE(stored().behind);
  EXPECT_EQ(stored().level, rewrite_of(1, {}).level);  // the level is the path's, not that of the tiles
  writer.rewrite_path(rewrite_of(2, map.trajectory));
  writer.caught_up(1);  // with the path before
  EXPECT_TRUE(stored().behind);
  writer.caught_up(2);
  EXPECT_FALSE(stored().behind);
  writer.rewrite_path(rewrite_of(3, map.trajectory));
  EXPECT_TRUE(stored().behind);
  MapBegin another = begin_of(random_map(5));
  another.epoch = "00000000000000ff";
  writer.begin(another);
  EXPECT_FALSE(stored().behind);
}

/// A disk that takes no more: the size of files is limited. True if the writer says so, goes on trying, and
/// has stored everything as soon as it may. In a process of its own, for the limit holds for all of it.
bool survives_a_full_disk(const std::filesystem::path& path, const StoredMap& map) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  StoreWriter writer(MapStore(path), map.options_json, map.calibration_json, milliseconds(5));
  StoredMap fresh = map;
  fresh.tiles.clear();
  fresh.trajectory.clear();
  writer.begin(begin_of(fresh));
  if (!writer.flush().ok) return false;
  const rlimit tight{20'000, limit.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &tight);
  writer.publish(map.tiles);
  writer.append_trajectory(map.trajectory);
  const StoreState full = writer.flush();
  const bool told = !full.ok && full.problem.find(path.string()) == 0 && full.waiting_tiles > 0 &&
                    full.problem.find("mapping goes on") != std::string::npos;
  ::setrlimit(RLIMIT_FSIZE, &limit);
  const StoreState better = writer.flush();
  return told && better.ok && better.problem.empty() && better.committed_revision == map.revision;
}

TEST(StoreWriter, ADiskThatRefusesIsToldInWordsAndTriedUntilItTakesEverything) {
  const TemporaryFolder folder;
  const StoredMap map = random_map(3);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(survives_a_full_disk(folder / "map.flog", map) ? 0 : 1);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(difference(load_map(folder / "map.flog"), map), "");
}

}  // namespace
}  // namespace flogmap::testing
