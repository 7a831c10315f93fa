#include "tests/bench/serve_snapshot.hpp"

#include <chrono>
#include <memory>
#include <random>
#include <stdexcept>

#include "flogmap/v1/stream.pb.h"
#include "tests/server/client_frames.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap {
namespace {

using std::chrono::steady_clock;

constexpr Bounds kLookedAt{-15, -10, 15, 10};
constexpr int kPatterns = 16;

/// Free ground with some walls, so that it packs as real tiles do.
std::shared_ptr<const Tile> made_up_tile(int num_layers, std::uint32_t seed, std::uint64_t revision) {
  std::mt19937 random(seed);
  Tile tile;
  std::vector<Cell> cells(static_cast<std::size_t>(kTileColumns) * num_layers);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool wall = (i / 7 + seed) % 23 == 0;
    const auto share = static_cast<std::uint16_t>(20'000 + random() % 4'000);
    cells[i] = {wall ? std::uint16_t{300} : share, wall ? share : std::uint16_t{100},
                static_cast<std::uint16_t>(20 + random() % 8), 0};
  }
  tile.cells = TileCells(cells.begin(), cells.end());
  tile.revision = revision;
  return std::make_shared<const Tile>(std::move(tile));
}

/// One who follows the stream and acknowledges all of it.
class Follower {
 public:
  explicit Follower(std::uint16_t port, const std::string& hello)
      : client_(port), start_(steady_clock::now()) {
    client_.send(hello);
    client_.send(subscribe_frame({{{}, Planes::evidence}, {}, 0, false}));
    client_.send(viewport_frame({kLookedAt, 0}));
  }

  /// Reads on to the end of the snapshot.
  void follow(const GridSpec& grid) {
    while (const auto bytes = client_.read(std::chrono::seconds(30))) {
      v1::ServerMessage message;
      if (!message.ParseFromString(*bytes)) throw std::runtime_error("no ServerMessage");
      if (message.has_snapshot_end()) break;
      if (!message.has_tile_batch()) continue;
      num_bytes_ += bytes->size();
      client_.send(ack_frame(num_bytes_));
      for (const auto& tile : message.tile_batch().tiles()) count(tile.key(), grid);
    }
    everything_s_ = elapsed_s();
  }

  std::size_t num_tiles_ = 0, num_visible_ = 0, num_bytes_ = 0;
  double last_visible_s_ = 0, everything_s_ = 0;

 private:
  void count(const v1::TileKey& key, const GridSpec& grid) {
    ++num_tiles_;
    if (key.level() != 0 || !intersect(kLookedAt, tile_bounds(grid, {0, key.x(), key.y()}))) return;
    ++num_visible_;
    last_visible_s_ = elapsed_s();
  }
  [[nodiscard]] double elapsed_s() const {
    return std::chrono::duration<double>(steady_clock::now() - start_).count();
  }

  StreamClient client_;
  steady_clock::time_point start_;
};

}  // namespace

MapBegin large_map(int side) {
  MapBegin map = SyntheticWalk().begin("b1900000000b1900", "started");
  map.revision = 1;
  std::vector<std::shared_ptr<const Tile>> patterns;
  for (std::uint32_t seed = 0; seed < kPatterns; ++seed) {
    patterns.push_back(made_up_tile(map.info.grid.num_layers(), seed, 1));
  }
  for (int x = -side / 2; x < side - side / 2; ++x) {
    for (int y = -side / 2; y < side - side / 2; ++y) {
      map.tiles.push_back({{x, y}, 1, patterns[map.tiles.size() % kPatterns]});
    }
  }
  return map;
}

std::vector<TileUpdate> changed_tiles(const MapBegin& map, int count, std::uint64_t revision) {
  const auto changed = made_up_tile(map.info.grid.num_layers(), 99, revision);
  std::vector<TileUpdate> updates;
  for (int i = 0; i < count; ++i) updates.push_back({map.tiles[i].index, revision, changed});
  return updates;
}

nlohmann::json arrive(std::uint16_t port) {
  Follower viewer(port, hello_frame());
  viewer.follow(SyntheticWalk().begin("", "").info.grid);
  return {{"viewport_tiles", viewer.num_visible_},
          {"viewport_s", viewer.last_visible_s_},
          {"everything_tiles", viewer.num_tiles_},
          {"everything_s", viewer.everything_s_},
          {"everything_mb", static_cast<double>(viewer.num_bytes_) / 1e6}};
}

nlohmann::json come_back(std::uint16_t port, const std::string& epoch, std::uint64_t revision) {
  Follower viewer(port, hello_frame(Resume{epoch, revision, 0}));
  viewer.follow(SyntheticWalk().begin("", "").info.grid);
  return {{"resume_tiles", viewer.num_tiles_},
          {"resume_kib", static_cast<double>(viewer.num_bytes_) / 1024},
          {"resume_s", viewer.everything_s_}};
}

}  // namespace flogmap
