// A store whose disk takes nothing when it is opened: it can be read, and written as soon as the disk
// relents.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/map_store.hpp"
#include "tests/server/file_limit.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

using ::testing::HasSubstr;

MapStore opened_on_a_full_disk(const std::filesystem::path& path) {
  const FileLimit full(0);
  return MapStore(path);
}

TEST(MapStoreDisk, AMapThatCanOnlyBeReadIsThereAndWrittenWhenTheDiskTakesIt) {
  const TemporaryFolder folder;
  const auto path = folder / "map.flog";
  StoredMap map = random_map(1);
  save_map(path, map);
  {
    MapStore store = opened_on_a_full_disk(path);
    EXPECT_FALSE(store.ended_cleanly());  // should it be killed, nothing tells the next one
    EXPECT_EQ(difference(*store.load(), map), "");
    {
      const FileLimit full(0);
      EXPECT_THAT(error_of([&] { store.begin(map); }), HasSubstr(path.string()));
      store.rollback();
    }
    EXPECT_EQ(difference(*store.load(), map), "");
    store.begin(map);
    map.tiles[0] = random_tile(map.tiles[0].index, 50, 3, 7);
    map.revision = 50;
    store.put_tiles(std::span(map.tiles).first(1));
    store.commit();
  }
  EXPECT_EQ(difference(load_map(path), map), "");
  EXPECT_TRUE(MapStore(path).ended_cleanly());
}

TEST(MapStoreDisk, WhatAnotherProgramWroteMeanwhileIsLeftAlone) {
  const TemporaryFolder folder;
  const auto path = folder / "map.flog";
  StoredMap map = random_map(2);
  save_map(path, map);
  {
    MapStore late = opened_on_a_full_disk(path);
    const StoredMap seen = *late.load();
    {
      MapStore other(path);
      map.tiles[0] = random_tile(map.tiles[0].index, 70, 3, 8);
      map.revision = 70;
      other.begin(map);
      other.commit();
    }
    for (int attempt = 0; attempt < 2; ++attempt) {
      EXPECT_THAT(error_of([&] { late.begin(seen); }), HasSubstr("by another program meanwhile"));
      late.rollback();
    }
  }
  EXPECT_EQ(difference(load_map(path), map), "");
}

TEST(MapStoreDisk, WhereThereIsNoMapAndNoneCanBeMadeItIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { opened_on_a_full_disk(folder / "map.flog"); }), HasSubstr("map.flog: "));
}

}  // namespace
}  // namespace flogmap::testing
