#pragma once

#include <memory>

#include "server/server_state.hpp"
#include "tests/server/fake_session.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap::fuzz {

/// A server's state with a map of some tiles, a path, pictures and a stored map, as requests and frames meet
/// it.
class WalkedMap {
 public:
  explicit WalkedMap(const ServeOptions& options = {}) : state_(options, session_, {}) {
    state_.live =
        std::make_unique<ServedMap>("live", walk_.begin("0000000000000001", "started"), Operators::algebraic);
    for (int i = 0; i < 12; ++i) step();
    state_.pictures = walk_.pictures();
    state_.status = walk_.status();
    state_.stored["empty"] = std::make_unique<ServedMap>(
        "empty", SyntheticWalk(2).begin("0000000000000002", "stored"), Operators::algebraic);
  }

  [[nodiscard]] ServerState& state() { return state_; }

  /// The slots that changed.
  std::vector<Slot> step() {
    const auto tiles = walk_.step();
    const TrackingReport report = walk_.tracking();
    state_.live->append(
        {report.timestamp_ns, *report.world_from_camera, report.tracking.state, report.mapped});
    return tiles.empty() ? std::vector<Slot>() : state_.live->update(walk_.revision(), tiles);
  }

 private:
  FakeSession session_;
  SyntheticWalk walk_;
  ServerState state_;
};

}  // namespace flogmap::fuzz
