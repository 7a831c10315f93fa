// A map file is read back as it was written, or refused in words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "server/map_store.hpp"
#include "server/store/map_digest.hpp"
#include "server/store/map_meta.hpp"
#include "server/store/map_rows.hpp"
#include "server/store/map_schema.hpp"
#include "server/store/sqlite.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr MapSize kTiny{.num_layers = 1, .tiles_per_side = 1, .num_poses = 3};

std::string refusal(const std::filesystem::path& path) {
  return error_of([&] { load_map(path); });
}

/// Every refusal names the file and, after a semicolon, the way out.
auto says(const std::filesystem::path& path, const std::string& what) {
  return AllOf(StartsWith(path.string() + ": "), HasSubstr(what), HasSubstr("; "));
}

TEST(MapFile, WhatIsSavedIsLoadedToTheLastBit) {
  const TemporaryFolder folder;
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const StoredMap map = random_map(seed, {.num_layers = 1 + static_cast<int>(seed)});
    save_map(folder / "map.flog", map);
    EXPECT_EQ(difference(load_map(folder / "map.flog"), map), "");
  }
}

TEST(MapFile, AMapWithoutTilesAndPathIsAMapToo) {
  const TemporaryFolder folder;
  const StoredMap map = empty_map(1, 2);
  save_map(folder / "map.flog", map);
  EXPECT_EQ(difference(load_map(folder / "map.flog"), map), "");
}

TEST(MapFile, SavingLeavesNothingElseBehind) {
  const TemporaryFolder folder;
  save_map(folder / "map.flog", random_map(1));
  save_map(folder / "map.flog", random_map(2));
  load_map(folder / "map.flog");
  const auto files = std::filesystem::directory_iterator(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(MapFile, AFailedSaveKeepsTheOldMap) {
  const TemporaryFolder folder;
  const StoredMap old = random_map(1);
  save_map(folder / "map.flog", old);
  StoredMap wrong = random_map(2);
  wrong.tiles[3] = random_tile(wrong.tiles[3].index, 4, 1, 7);  // of one layer instead of three
  EXPECT_THROW(save_map(folder / "map.flog", wrong), std::invalid_argument);
  wrong = random_map(2);
  wrong.info.grid.cell_size_m = -1;
  EXPECT_THROW(save_map(folder / "map.flog", wrong), std::invalid_argument);
  EXPECT_EQ(difference(load_map(folder / "map.flog"), old), "");
  EXPECT_THAT(error_of([&] { save_map(folder / "nowhere/map.flog", old); }),
              says(folder / "nowhere/map.flog", "cannot be written"));
}

TEST(MapFile, AFlippedByteIsRefusedOrMakesNoDifference) {
  const TemporaryFolder folder;
  const StoredMap map = random_map(3, kTiny);
  save_map(folder / "map.flog", map);
  const auto sound = read_bytes(folder / "map.flog");
  std::mt19937 random(1);
  int refused = 0, tried = 0;
  for (std::size_t at = 0; at < sound.size(); at += at < 200 ? 1 : 1 + random() % 50, ++tried) {
    auto bytes = sound;
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1 + random() % 255));
    write_bytes(folder / "bad.flog", bytes);
    try {
      EXPECT_EQ(difference(load_map(folder / "bad.flog"), map), "") << "byte " << at;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), says(folder / "bad.flog", "")) << "byte " << at;
      ++refused;
    }
  }
  EXPECT_GT(tried, 1000);
  EXPECT_GT(refused, tried / 20);  // most of so small a file is unused space
}

TEST(MapFile, OverwrittenRegionsAreRefusedOrMakeNoDifference) {
  const TemporaryFolder folder;
  const StoredMap map = random_map(4, {.num_layers = 2, .tiles_per_side = 2, .num_poses = 40});
  save_map(folder / "map.flog", map);
  const auto sound = read_bytes(folder / "map.flog");
  std::mt19937 random(2);
  for (std::size_t at = 0; at + 256 <= sound.size(); at += 256) {
    auto bytes = sound;
    std::generate_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), 256,
                    [&] { return static_cast<std::uint8_t>(random()); });
    write_bytes(folder / "bad.flog", bytes);
    try {
      EXPECT_EQ(difference(load_map(folder / "bad.flog"), map), "") << "region at " << at;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), says(folder / "bad.flog", "")) << "region at " << at;
    }
  }
}

TEST(MapFile, ATruncatedFileIsRefused) {
  const TemporaryFolder folder;
  save_map(folder / "map.flog", random_map(5, kTiny));
  const auto sound = read_bytes(folder / "map.flog");
  for (std::size_t size = 0; size < sound.size(); size += 1024) {
    write_bytes(folder / "bad.flog", {sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_THAT(refusal(folder / "bad.flog"), says(folder / "bad.flog", "")) << size << " bytes";
  }
}

TEST(MapFile, GarbageIsRefused) {
  const TemporaryFolder folder;
  std::mt19937 random(6);
  const std::string magic("SQLite format 3\0", 16);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> bytes(random() % 20'000);
    std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(random()); });
    if (i % 2 == 0 && bytes.size() > 100) std::copy(magic.begin(), magic.end(), bytes.begin());
    write_bytes(folder / "bad.flog", bytes);
    EXPECT_THAT(refusal(folder / "bad.flog"), says(folder / "bad.flog", ""));
  }
}

TEST(MapFile, WhatIsNoFileIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(folder / "none.flog"), says(folder / "none.flog", "no such file"));
  EXPECT_THAT(refusal(folder.path()), says(folder.path(), "not a file"));
  write_bytes(folder / "empty.flog", {});
  EXPECT_THAT(refusal(folder / "empty.flog"), says(folder / "empty.flog", "is empty"));
}

/// A map changed behind the program's back by somebody who knows SQLite.
class ForgedMap : public ::testing::Test {
 protected:
  std::string refusal_after(const std::string& sql) {
    save_map(path_, random_map(7, kTiny));
    SqliteDatabase(path_, SqliteDatabase::Mode::write).execute(sql);
    return refusal(path_);
  }
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "map.flog";
};

TEST_F(ForgedMap, OfANewerProgramAsksForAnUpdate) {
  EXPECT_THAT(refusal_after("PRAGMA user_version = 2"), says(path_, "newer flogmap (format 2"));
}

TEST_F(ForgedMap, OfAnotherProgramIsNoMap) {
  EXPECT_THAT(refusal_after("PRAGMA application_id = 7"), says(path_, "another program"));
}

TEST_F(ForgedMap, WithOtherTablesIsRefused) {
  EXPECT_THAT(refusal_after("CREATE TABLE more (x)"), says(path_, "tables"));
  EXPECT_THAT(refusal_after("DROP TABLE views"), says(path_, "tables"));
  EXPECT_THAT(refusal_after("ALTER TABLE tiles ADD COLUMN z INTEGER"), says(path_, "table tiles"));
  EXPECT_THAT(refusal_after("DROP TABLE tiles; CREATE VIEW tiles AS SELECT 1 AS x"),
              says(path_, "table tiles"));
}

TEST_F(ForgedMap, WithMissingOrDoubledRowsIsRefused) {
  EXPECT_THAT(refusal_after("DELETE FROM tiles"), says(path_, "tiles are missing"));
  EXPECT_THAT(refusal_after("DELETE FROM trajectory WHERE number = 2"), says(path_, "poses are missing"));
  EXPECT_THAT(refusal_after("DELETE FROM trajectory WHERE number = 1"), says(path_, "pose 1"));
  EXPECT_THAT(refusal_after("DELETE FROM meta WHERE name = 'options'"), says(path_, "'options' is missing"));
  EXPECT_THAT(refusal_after("DELETE FROM meta"), says(path_, "holds no map yet"));
  EXPECT_THAT(refusal_after("INSERT INTO tiles SELECT x + 1, y, revision, cells, checksum FROM tiles"),
              says(path_, "checksum"));
}

TEST_F(ForgedMap, WithChangedValuesIsRefused) {
  EXPECT_THAT(refusal_after("UPDATE tiles SET y = y + 1"), says(path_, "fails its checksum"));
  EXPECT_THAT(refusal_after("UPDATE tiles SET revision = 0"), says(path_, "fails its checksum"));
  EXPECT_THAT(refusal_after("UPDATE tiles SET cells = x'00'"), says(path_, "fails its checksum"));
  EXPECT_THAT(refusal_after("UPDATE trajectory SET mapped = 1 - mapped"), says(path_, "checksum"));
  EXPECT_THAT(refusal_after("UPDATE trajectory SET state = 4"), says(path_, "impossible"));
  EXPECT_THAT(refusal_after("UPDATE trajectory SET pose = x'00'"), says(path_, "impossible"));
  EXPECT_THAT(refusal_after("UPDATE meta SET value = '{}' WHERE name = 'map'"), says(path_, "'map'"));
}

TEST_F(ForgedMap, WithATileOutOfRangeIsRefusedBeforeItsChecksum) {
  EXPECT_THAT(refusal_after("UPDATE tiles SET x = 33554432"), says(path_, "out of range"));
  EXPECT_THAT(refusal_after("UPDATE tiles SET y = -9000000000"), says(path_, "out of range"));
}

TEST_F(ForgedMap, WithATileOfAnotherSizeIsRefusedThoughItsChecksumsAreRight) {
  StoredMap map = random_map(8, kTiny);
  save_map(path_, map);
  const std::vector<std::uint8_t> cells{0x78, 0x9c, 0x03, 0x00,
                                        0x00, 0x00, 0x00, 0x01};  // nothing, compressed
  const auto sum = static_cast<std::int64_t>(tile_checksum(map.tiles[0].index, map.tiles[0].revision, cells));
  SqliteDatabase database(path_, SqliteDatabase::Mode::write);
  database.prepare("UPDATE tiles SET cells = ?, checksum = ?").bind(1, cells).bind(2, sum).run();
  EXPECT_THAT(refusal(path_), says(path_, "does not unpack"));
}

TEST_F(ForgedMap, ThatClaimsMoreTilesThanAnyMemoryHoldsIsRefused) {
  save_map(path_, random_map(9, kTiny));
  SqliteDatabase database(path_, SqliteDatabase::Mode::write);
  MapSeal seal = read_seal(database);
  seal.num_tiles = 1'000'000;
  write_seal(database, seal);
  EXPECT_THAT(refusal(path_), says(path_, "more than the 16 GiB"));
}

TEST(MapFile, OtherCellsOrLayersThanAskedForAreNamedWithTheWayOut) {
  const GridSpec stored{0.02, {0.05, 0.75}};
  EXPECT_NO_THROW(check_same_grid("m.flog", stored, stored));
  EXPECT_EQ(error_of([&] {
              check_same_grid("m.flog", stored, {0.05, {0.05, 0.75}});
            }),
            "m.flog: this map was made with --cell-size 0.02, now it is 0.05; start with --cell-size 0.02, "
            "or name another file for a new map");
  EXPECT_THAT(error_of([&] {
                check_same_grid("m.flog", stored, {0.02, {0.05, 0.7, 1}});
              }),
              HasSubstr("--layers 0.05,0.75, now it is 0.05,0.7,1;"));
}

TEST(MapDigest, DependsOnCellsAndPosesAlone) {
  const StoredMap map = random_map(9);
  StoredMap same = map;
  same.epoch = "0123456789abcdef";
  same.revision += 7;
  std::reverse(same.tiles.begin(), same.tiles.end());
  auto blank = std::make_shared<Tile>();
  blank->cells.resize(map.tiles[0].tile->cells.size());
  same.tiles.push_back({{900, -900}, 1, blank});
  EXPECT_EQ(map_digest(same), map_digest(map));
  EXPECT_EQ(map_digest(map).size(), 64U);

  StoredMap other = map;
  auto tile = std::make_shared<Tile>(*other.tiles[4].tile);
  tile->cells.back().rays ^= 1;
  other.tiles[4].tile = tile;
  EXPECT_NE(map_digest(other), map_digest(map));
  other = map;
  other.trajectory[3].world_from_camera.translation().x() += 1e-15;
  EXPECT_NE(map_digest(other), map_digest(map));
}

TEST(MapDigest, OutlivesTheFile) {
  const TemporaryFolder folder;
  const StoredMap map = random_map(10);
  save_map(folder / "map.flog", map);
  EXPECT_EQ(map_digest(load_map(folder / "map.flog")), map_digest(map));
}

TEST(MapDigest, IsTheSameOnEveryMachine) {
  StoredMap map = empty_map(0, 1);
  auto tile = std::make_shared<Tile>();
  tile->cells.resize(kTileColumns);
  tile->cells[65] = {1, 2, 3, 4};
  map.tiles = {{{-1, 2}, 1, tile}};
  map.trajectory.push_back({});
  EXPECT_EQ(map_digest(map), "cd6fbf0271acb1303a59ed6f1c77c1890b61c5e3a049a3b20fe28e63292420a8");
}

}  // namespace
}  // namespace flogmap::testing
