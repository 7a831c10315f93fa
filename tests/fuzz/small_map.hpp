#pragma once

#include <array>
#include <memory>
#include <vector>

#include "server/server_state.hpp"
#include "tests/server/fake_session.hpp"

namespace flogmap::fuzz {

/// A server's state with a map of four tiles and a short path, whose tiles and overviews are encoded once and
/// for all: a target that is run thousands of times a second waits for no map to be drawn.
class SmallMap {
 public:
  SmallMap() : state_({}, session_, {}) {
    info_.grid.layer_bounds_m = {0.05, 0.75, 1.45};
    info_.full_confidence_rays.assign(2, 60);
    for (std::uint16_t look = 0; look < 2; ++look) looks_[look] = tile_of(look);
    MapBegin begin{.epoch = "0000000000000001", .info = info_, .camera = {435, 376, 240, 0.11, 752, 480}};
    for (int i = 0; i < 4; ++i) begin.tiles.push_back(update({i % 2, i / 2}));
    begin.revision = revision_;
    for (int i = 0; i < 20; ++i) begin.trajectory.push_back(entry());
    first_.push_back(encoded(begin));
    begin.epoch = "0000000000000002";
    first_.push_back(encoded(begin));
    begin_map(0);
  }

  [[nodiscard]] ServerState& state() { return state_; }

  /// The first or the second map, as it was at its beginning, whatever came before.
  void begin_map(std::size_t which) {
    state_.live = std::make_unique<ServedMap>(first_[which]);
    revision_ = first_[which].revision();
    num_poses_ = first_[which].trajectory().size();
  }

  /// One tile of the four changes, in turn, and the path grows by a pose. Returns the slots that changed.
  std::vector<Slot> step() {
    const int tile = static_cast<int>(revision_ % 4);
    const std::vector<TileUpdate> updates{update({tile % 2, tile / 2})};
    state_.live->append(entry());
    return state_.live->update(revision_, updates);
  }

  void rewrite_path() { state_.live->rewrite(std::vector<TrajectoryEntry>(state_.live->trajectory())); }

 private:
  static ServedMap encoded(const MapBegin& begin) {
    ServedMap map("live", begin, Operators::algebraic);
    for (Slot slot = 0; slot < map.board().num_slots(); ++slot) {
      for (const Planes planes : {Planes::value, Planes::evidence})
        (void)map.board().message(slot, {{}, planes});
    }
    return map;
  }
  [[nodiscard]] std::shared_ptr<Tile> tile_of(std::uint16_t look) const {
    auto tile = std::make_shared<Tile>();
    const auto seen = static_cast<std::uint16_t>(20'000 + look * 20'000);
    tile->cells.assign(2 * kTileColumns, Cell{seen, 100, 30, 0});
    return tile;
  }
  TileUpdate update(TileIndex index) {
    auto tile = std::make_shared<Tile>(*looks_[++revision_ % 8 / 4]);
    tile->revision = revision_;
    return {index, revision_, tile};
  }
  TrajectoryEntry entry() {
    return {static_cast<std::int64_t>(++num_poses_) * 50'000'000, SE3::Identity(), TrackingState::ok, true};
  }

  FakeSession session_;
  MapInfo info_;
  std::array<std::shared_ptr<Tile>, 2> looks_;
  std::uint64_t revision_ = 0, num_poses_ = 0;
  std::vector<ServedMap> first_;
  ServerState state_;
};

}  // namespace flogmap::fuzz
