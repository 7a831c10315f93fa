// Killed between a corrected path and the tiles that follow it, the map goes on with walls where the path
// says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/commands/continued_map.hpp"
#include "server/store/store_writer.hpp"
#include "server/views/view_keeper.hpp"
#include "tests/server/map_store_support.hpp"
#include "tests/server/mapped_path.hpp"
#include "tests/server/round_trip.hpp"

namespace flogmap {
namespace {

using testing::TemporaryFolder;

/// Stores a map as `serve` does, and keeps what a kill would leave right after a corrected path was stored.
class StoredPath final : public PipelineObserver {
 public:
  explicit StoredPath(const TemporaryFolder& folder)
      : live_(folder / "live.flog"), killed_(folder / "killed.flog"), writer_(MapStore(live_), "{}", "{}") {}

  void map_begins(const MapBegin& begin) override { writer_.begin(begin); }
  void map_changed(std::uint64_t /*revision*/, const std::vector<TileUpdate>& updates) override {
    writer_.publish(updates);
  }
  void view_mapped(const View& view) override {
    if (SharedView kept = keeper_.keep(view)) writer_.put_view(std::move(kept));
  }
  void path_grew(const std::vector<TrajectoryEntry>& entries) override { writer_.append_trajectory(entries); }
  void path_rewritten(const PathRewrite& rewrite) override {
    writer_.rewrite_path(rewrite);
    writer_.flush();
    for (const char* part : {"", "-wal"})
      testing::write_bytes(killed_.string() + part, testing::read_bytes(live_.string() + part));
  }
  void map_caught_up(std::uint64_t number) override { writer_.caught_up(number); }
  void frame_tracked(const TrackingReport& /*report*/) override {}
  void pictures_taken(const PictureReport& /*report*/) override {}
  void status_changed(const StatusReport& /*report*/) override {}

  StoredMap whole() {
    EXPECT_TRUE(writer_.flush().ok);
    return load_map(live_);
  }
  [[nodiscard]] const std::filesystem::path& killed() const { return killed_; }

 private:
  std::filesystem::path live_, killed_;
  StoreWriter writer_;
  ViewKeeper keeper_;
};

/// The walk in which a loop is closed, in batch: no tile follows the corrected path before the end.
void map_round_trip_into(StoredPath& store) {
  FrontEndOptions options;
  options.views.translation_m = 0.01;
  auto source = std::make_unique<MemorySource>(round_trip().recorded);
  FrontEnd front_end(options, Rectifier(*source->calibration()),
                     GivenPoses(round_trip().odometry, SE3::Identity()), std::nullopt);
  MapIntegrator integrator(coarse_map(2), front_end.camera(), front_end.max_disparity_px());
  PipelineOptions pipeline_options;
  pipeline_options.rate = 0;
  pipeline_options.end_with_source = true;
  pipeline_options.loop_closure = LoopOptions{};
  Pipeline pipeline(pipeline_options, std::move(source), std::move(front_end), std::move(integrator), store);
  pipeline.start();
  pipeline.wait();
}

using Tiles = std::map<TileIndex, std::shared_ptr<const Tile>>;

Tiles tiles_of(const StoredMap& map) { return snapshot_of(map).tiles; }

bool occupied(const Tiles& tiles, int x, int y, std::size_t layer) {
  const auto tile = tiles.find({x >> kTileShift, y >> kTileShift});
  if (tile == tiles.end()) return false;
  const int column = (y & (kTileSide - 1)) * kTileSide + (x & (kTileSide - 1));
  const Cell& cell = tile->second->cells[layer * kTileColumns + static_cast<std::size_t>(column)];
  return cell.rays >= 8 && cell.occupied > cell.empty;
}

/// Of the occupied cells of `a`, the share that stand in `b` too or right beside.
double share_found(const Tiles& a, const Tiles& b) {
  int cells = 0, found = 0;
  for (const auto& [index, tile] : a) {
    for (std::size_t i = 0; i < tile->cells.size(); ++i) {
      const int column = static_cast<int>(i % kTileColumns);
      const int x = index.x * kTileSide + column % kTileSide, y = index.y * kTileSide + column / kTileSide;
      if (!occupied(a, x, y, i / kTileColumns)) continue;
      ++cells;
      bool near = false;
      for (int k = 0; k < 9; ++k) near = near || occupied(b, x + k % 3 - 1, y + k / 3 - 1, i / kTileColumns);
      found += near ? 1 : 0;
    }
  }
  return cells == 0 ? 0 : found / static_cast<double>(cells);
}

TEST(ContinuedMap, KilledBeforeTheTilesFollowedTheCorrectedPathTheyAreBuiltAnewForIt) {
  const TemporaryFolder folder;
  StoredPath store(folder);
  map_round_trip_into(store);
  const StoredMap whole = store.whole();
  EXPECT_FALSE(whole.behind);
  const StoredMap behind = load_map(store.killed());
  ASSERT_TRUE(behind.behind);
  EXPECT_GT(share_found(tiles_of(load_settled_map(store.killed())), tiles_of(whole)),
            0.98);  // only to look at
  EXPECT_TRUE(load_map(store.killed()).behind);
  MapStore again(store.killed());
  const std::optional<StoredMap> taken_up = take_up(again, coarse_map(2));
  ASSERT_TRUE(taken_up.has_value());
  EXPECT_FALSE(taken_up->behind);
  EXPECT_EQ(taken_up->epoch, behind.epoch);
  EXPECT_GT(taken_up->revision, behind.revision);
  EXPECT_LT(share_found(tiles_of(behind), tiles_of(whole)), 0.95);  // else nothing was wrong
  EXPECT_GT(share_found(tiles_of(*taken_up), tiles_of(whole)), 0.98);
  EXPECT_GT(share_found(tiles_of(whole), tiles_of(*taken_up)), 0.98);
  EXPECT_EQ(testing::difference(load_map(store.killed()), *taken_up),
            "");  // at once, not when mapping goes on
}

}  // namespace
}  // namespace flogmap
