// The live store: what was committed is there, what was not is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "server/map_store.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

using ::testing::HasSubstr;

TEST(MapStore, GoesOnWithTheSameMapAfterARestart) {
  const TemporaryFolder folder;
  const auto path = folder / "map.flog";
  StoredMap map = random_map(1);
  {
    MapStore store(path);
    EXPECT_FALSE(store.load().has_value());
    store.begin(map);
    store.commit();
  }
  MapStore store(path);
  EXPECT_TRUE(store.ended_cleanly());
  const auto stored = store.load();
  ASSERT_TRUE(stored.has_value());
  EXPECT_EQ(difference(*stored, map), "");

  store.begin(*stored);
  map.tiles[2] = random_tile(map.tiles[2].index, 50, 3, 99);
  map.trajectory.push_back(random_pose(1'000'000'000, 5));
  store.put_tiles(std::span(map.tiles).subspan(2, 1));
  store.append_trajectory(std::span(map.trajectory).last(1));
  store.commit();
  map.revision = 50;
  EXPECT_EQ(store.revision(), 50U);
  EXPECT_EQ(difference(*store.load(), map), "");
}

TEST(MapStore, KeepsHowTheMapWasLevelledUntilItIsLevelledAgain) {
  const TemporaryFolder folder;
  StoredMap map = random_map(1);
  map.level = {.roll_rad = 0.1, .pitch_rad = -0.02, .yaw_rad = 1.5, .height_m = 0.3};
  {
    MapStore store(folder / "map.flog");
    store.begin(map);
    store.commit();
    EXPECT_EQ(difference(*store.load(), map), "");
    map.level.height_m = -0.1;
    store.put_level(map.level);
    store.commit();
  }
  EXPECT_EQ(difference(load_map(folder / "map.flog"), map), "");
}

TEST(MapStore, SaysThatItsTilesAreBehindUntilToldOtherwise) {
  const TemporaryFolder folder;
  const auto path = folder / "map.flog";
  StoredMap map = random_map(1);
  {
    MapStore store(path);
    store.begin(map);
    store.set_behind(true);
    store.commit();
    EXPECT_TRUE(load_map(path).behind);
  }
  MapStore store(path);
  EXPECT_TRUE(store.load()->behind);
  map.behind = false;
  store.begin(map);  // goes on with tiles that follow the path
  store.commit();
  EXPECT_FALSE(load_map(path).behind);
  store.set_behind(true);
  store.rollback();
  store.commit();
  EXPECT_FALSE(load_map(path).behind);
}

TEST(MapStore, CanBeReadByOthersWhileItIsWritten) {
  const TemporaryFolder folder;
  const StoredMap first = random_map(1);
  MapStore store(folder / "map.flog");
  store.begin(first);
  store.commit();
  const std::vector<TileUpdate> later{random_tile({7, 7}, 60, 3, 1)};
  store.put_tiles(later);
  EXPECT_EQ(difference(load_map(folder / "map.flog"), first), "");  // as of the last commit
  store.commit();
  EXPECT_EQ(load_map(folder / "map.flog").revision, 60U);
}

TEST(MapStore, ClosedItIsOnePlainFile) {
  const TemporaryFolder folder;
  {
    MapStore store(folder / "map.flog");
    store.begin(random_map(1));
    store.commit();
  }
  const auto files = std::filesystem::directory_iterator(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(MapStore, AnOlderTileNeverReplacesANewerOne) {
  const TemporaryFolder folder;
  StoredMap map = random_map(2);
  MapStore store(folder / "map.flog");
  store.begin(map);
  const std::vector<TileUpdate> older{random_tile(map.tiles[4].index, map.tiles[4].revision - 1, 3, 77)};
  store.put_tiles(older);
  store.commit();
  EXPECT_EQ(difference(*store.load(), map), "");
}

TEST(MapStore, AnotherEpochEmptiesIt) {
  const TemporaryFolder folder;
  MapStore store(folder / "map.flog");
  store.begin(random_map(3));
  store.put_view({.number = 0, .bytes = {1, 2, 3}});
  store.commit();
  const StoredMap fresh = empty_map(4, 2);
  store.begin(fresh);
  store.commit();
  EXPECT_EQ(difference(*store.load(), fresh), "");
  EXPECT_TRUE(store.view_numbers().empty());
}

TEST(MapStore, TheSameEpochWithOtherCellsIsRefused) {
  const TemporaryFolder folder;
  StoredMap map = random_map(5);
  MapStore store(folder / "map.flog");
  store.begin(map);
  store.commit();
  StoredMap other = map;
  other.info.grid.cell_size_m = 0.05;
  EXPECT_THAT(error_of([&] { store.begin(other); }), HasSubstr("--cell-size 0.02"));
  EXPECT_EQ(difference(*store.load(), map), "");
}

TEST(MapStore, ARewrittenPathReplacesTheOldOne) {
  const TemporaryFolder folder;
  StoredMap map = random_map(6);
  MapStore store(folder / "map.flog");
  store.begin(map);
  store.commit();
  map.trajectory.clear();
  for (int i = 0; i < 31; ++i) map.trajectory.push_back(random_pose(i, 1000 + static_cast<std::uint32_t>(i)));
  store.rewrite_trajectory(map.trajectory);
  store.commit();
  EXPECT_EQ(difference(*store.load(), map), "");
}

TEST(MapStore, ViewsComeBackAsTheyWereGiven) {
  const TemporaryFolder folder;
  MapStore store(folder / "map.flog");
  store.begin(random_map(7));
  const SE3 pose = random_pose(0, 3).world_from_camera;
  store.put_view({0, 11, pose, 2, {9, 8, 7}});
  store.put_view({4, 12, pose, 2, {}});
  store.put_view({0, 13, pose, 3, std::vector<std::uint8_t>(100'000, 5)});
  store.commit();
  EXPECT_EQ(store.view_numbers(), (std::vector<std::int64_t>{0, 4}));
  const auto view = store.view(0);
  ASSERT_TRUE(view.has_value());
  EXPECT_EQ(view->timestamp_ns, 13);
  EXPECT_EQ(view->codec, 3);
  EXPECT_EQ(view->bytes, std::vector<std::uint8_t>(100'000, 5));
  EXPECT_EQ(view->world_from_camera.matrix(), pose.matrix());
  EXPECT_FALSE(store.view(1).has_value());
  const StoredMap whole = load_map(folder / "map.flog");
  ASSERT_EQ(whole.views.size(), 2U);
  EXPECT_EQ(whole.views[1]->number, 4);
  save_map(folder / "copy.flog", whole);
  EXPECT_EQ(load_map(folder / "copy.flog").views.at(0)->bytes, view->bytes);
}

TEST(MapStore, RollbackForgetsBackToTheLastCommit) {
  const TemporaryFolder folder;
  StoredMap map = random_map(8);
  MapStore store(folder / "map.flog");
  store.begin(map);
  store.commit();
  store.begin(empty_map(9, 2));
  store.rollback();
  const std::vector<TileUpdate> late{random_tile({3, 3}, 90, 3, 1)};
  store.put_tiles(late);
  store.rollback();
  EXPECT_EQ(store.revision(), map.revision);
  store.put_tiles(late);
  store.commit();
  map.tiles.push_back(late[0]);
  map.revision = 90;
  EXPECT_EQ(difference(*store.load(), map), "");
}

TEST(MapStore, NothingIsAddedBeforeAMapBegins) {
  const TemporaryFolder folder;
  MapStore store(folder / "map.flog");
  EXPECT_THROW(store.put_tiles({}), std::logic_error);
  store.commit();
  EXPECT_FALSE(store.load().has_value());
}

TEST(MapStore, HasOneWriterAtATime) {
  const TemporaryFolder folder;
  const auto path = folder / "map.flog";
  {
    MapStore store(path);
    EXPECT_THAT(error_of([&] { MapStore second(path); }), HasSubstr("another flogmap (process "));
    EXPECT_THAT(error_of([&] { save_map(path, random_map(1)); }), HasSubstr("is writing to it"));
  }
  EXPECT_NO_THROW(MapStore again(path));
}

TEST(MapStore, WillNotTouchTheFileOfAnotherProgram) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> text(5000, 'x');
  write_bytes(folder / "letter.txt", text);
  EXPECT_THAT(error_of([&] { MapStore store(folder / "letter.txt"); }), HasSubstr("letter.txt: not a map"));
  EXPECT_EQ(read_bytes(folder / "letter.txt"), text);
  EXPECT_THAT(error_of([&] { MapStore store(folder / "nowhere/map.flog"); }), HasSubstr("cannot be written"));
}

/// Files as a killed writer leaves them: the database and its journal, copied while the store is open.
struct KilledStore {
  TemporaryFolder folder;
  std::filesystem::path path = folder / "map.flog";
  std::vector<StoredMap> states;
  std::vector<std::uint8_t> database, journal;

  KilledStore() {
    MapStore store(folder / "live.flog");
    StoredMap map = empty_map(11, 1);
    store.begin(map);
    for (std::uint32_t i = 1; i <= 5; ++i) {
      map.tiles.push_back(random_tile({static_cast<int>(i), 0}, i, 1, i));
      map.revision = i;
      store.put_tiles(std::span(map.tiles).last(1));
      store.commit();
      states.push_back(map);
    }
    database = read_bytes(folder / "live.flog");
    journal = read_bytes(folder / "live.flog-wal");
  }
  void restore() const {
    std::filesystem::remove(path.string() + "-shm");
    write_bytes(path, database);
    write_bytes(path.string() + "-wal", journal);
  }
};

TEST(MapStore, KilledItOpensAsOfItsLastCommitAndSaysSo) {
  const KilledStore killed;
  killed.restore();
  EXPECT_EQ(difference(load_map(killed.path), killed.states.back()), "");
  const MapStore store(killed.path);
  EXPECT_FALSE(store.ended_cleanly());
  EXPECT_EQ(difference(*store.load(), killed.states.back()), "");
}

TEST(MapStore, AJournalLeftBehindIsNotReplayedIntoTheMapThatReplacesItsOwn) {
  const KilledStore killed;
  killed.restore();
  const StoredMap other = random_map(12);
  save_map(killed.path, other);
  EXPECT_EQ(difference(load_map(killed.path), other), "");
}

TEST(MapStore, ADamagedJournalGivesAnEarlierCommitOrARefusal) {
  KilledStore killed;
  std::mt19937 random(3);
  const auto sound = killed.journal;
  for (std::size_t at = random() % 64; at < sound.size(); at += 1 + random() % 1000) {
    killed.journal = sound;
    killed.journal[at] = static_cast<std::uint8_t>(killed.journal[at] ^ (1 + random() % 255));
    killed.restore();
    try {
      const StoredMap map = load_map(killed.path);
      const bool committed = std::ranges::any_of(
          killed.states, [&](const StoredMap& state) { return difference(map, state).empty(); });
      EXPECT_TRUE(committed) << "byte " << at;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(killed.path.string() + ": ")) << "byte " << at;
    }
  }
}

}  // namespace
}  // namespace flogmap::testing
