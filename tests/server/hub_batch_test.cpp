// Tiles by the batch: only what is newer than what the client has, in the layers that it asks for.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/server/stream_fixture.hpp"

namespace flogmap {
namespace {

using nlohmann::json;

class BatchTest : public StreamTest {
 protected:
  json batch(const json& body) {
    const HttpReply reply =
        http(server_.port(), "POST", "/api/v1/maps/live/tiles:batchGet",
             {{"Content-Type", "application/json"}, {"Accept", "application/json"}}, body.dump());
    EXPECT_EQ(reply.status, 200) << reply.body;
    return json::parse(reply.body);
  }
  json changed() {
    return json::parse(http(server_.port(), "GET", "/api/v1/maps/live/changes?limit=10000").body)["tiles"];
  }
};

TEST_F(BatchTest, OnlyTilesNewerThanThoseOfTheClientCome) {
  begin();
  step(20);
  const json before = changed();
  EXPECT_EQ(batch({{"tiles", before}})["tiles"].size(), 0U);
  step(20);
  std::size_t newer = 0;
  for (const json& tile : changed())
    newer += std::find(before.begin(), before.end(), tile) == before.end() ? 1 : 0;
  json wanted = before;  // as it was known, and what is new
  for (json tile : changed()) {
    const bool known = std::any_of(before.begin(), before.end(), [&](const json& old) {
      return old["level"] == tile["level"] && old["x"] == tile["x"] && old["y"] == tile["y"];
    });
    if (known) continue;
    tile.erase("rev");
    wanted.push_back(tile);
  }
  ASSERT_GT(newer, 0U);
  EXPECT_EQ(batch({{"tiles", wanted}})["tiles"].size(), newer);
}

TEST_F(BatchTest, OfARevisionThatNeverWasTheTileComesAnew) {
  begin();
  step(20);
  json tile = changed().at(0);
  tile["rev"] = truth_->revision() + 5;
  EXPECT_EQ(batch({{"tiles", {tile}}})["tiles"].size(), 1U);
}

TEST_F(BatchTest, OnlyTheLayersThatAreAskedForCome) {
  begin();
  step(20);
  json tile = changed().at(0);
  tile.erase("rev");
  const json some = batch({{"tiles", {tile}}, {"layers", {2, 0}}})["tiles"][0]["layers"];
  ASSERT_EQ(some.size(), 2U);
  EXPECT_EQ(some[0]["layer"], 0);
  EXPECT_EQ(some[1]["layer"], 2);
  EXPECT_EQ(batch({{"tiles", {tile}}})["tiles"][0]["layers"].size(), 3U);
}

TEST_F(BatchTest, TilesThatAreGoneSinceAreNamed) {
  begin();
  step(20);
  const json tile = changed().at(0);
  ASSERT_EQ(tile["level"], 0);
  const TileIndex index{tile["x"].get<std::int32_t>(), tile["y"].get<std::int32_t>()};
  const std::uint64_t gone = truth_->revision() + 1;
  const std::vector<TileUpdate> removal{{index, gone, nullptr}};
  truth_->update(gone, removal);
  server_.hub().publish(gone, removal);
  settle();
  const json reply = batch({{"tiles", {tile}}});
  EXPECT_EQ(reply["tiles"].size(), 0U);
  ASSERT_EQ(reply["removed"].size(), 1U);
  EXPECT_EQ(reply["removed"][0]["x"], tile["x"]);
}

}  // namespace
}  // namespace flogmap
