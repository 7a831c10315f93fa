// The store on a thread of its own, so that mapping never waits for a disk.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/map_store.hpp"
#include "server/path_rewrite.hpp"
#include "server/publication.hpp"

namespace flogmap {

/// What the disk says.
struct StoreState {
  bool ok = true;
  std::string problem;                   // in words while not ok: what failed, what to do, what goes on
  std::uint64_t committed_revision = 0;  // of the map that is durable
  std::uint64_t commits = 0;
  std::size_t waiting_tiles = 0;  // published, not yet durable
};

/// The newest state of what is not durable yet: one entry per tile, so that a disk that stands still costs no
/// more than the map itself.
struct StoreMailbox {
  std::optional<MapBegin> begin;
  std::map<TileIndex, TileUpdate> tiles;
  std::optional<PathRewrite> path;  // the whole path anew, before `new_poses`
  std::vector<TrajectoryEntry> new_poses;
  std::map<std::int64_t, SharedView> views;
  std::optional<std::uint64_t> caught_up;  // the tiles are those of the path of this number

  [[nodiscard]] bool empty() const {
    return !begin && tiles.empty() && !path && new_poses.empty() && views.empty() && !caught_up;
  }
  /// Adds what was said later: a new map or path replaces what was before, a newer tile the older one.
  void merge(StoreMailbox later);
};

/// Owns a store and commits what is published at least once a second, each commit one moment of the map. When
/// the disk refuses it says so in state() and keeps trying; nothing published is lost meanwhile.
class StoreWriter {
 public:
  using Milliseconds = std::chrono::milliseconds;

  /// options_json and calibration_json go into the file with every map that begins.
  StoreWriter(MapStore store, std::string options_json, std::string calibration_json,
              Milliseconds commit_every = Milliseconds(500));
  StoreWriter(const StoreWriter&) = delete;
  StoreWriter& operator=(const StoreWriter&) = delete;
  ~StoreWriter();  // tries once more to commit what waits, then closes the store

  // From any thread, at once.
  void begin(MapBegin map);
  void publish(const std::vector<TileUpdate>& updates);
  void append_trajectory(const std::vector<TrajectoryEntry>& entries);
  void rewrite_path(PathRewrite rewrite);
  /// The tiles of this path have been published. Until then the store says of itself that they are behind.
  void caught_up(std::uint64_t number);
  void put_view(SharedView view);
  [[nodiscard]] StoreState state() const;

  /// Commits now and returns when everything published before is durable, or when the disk refused it.
  StoreState flush();

 private:
  void post(StoreMailbox later);
  void run(const std::stop_token& stop);
  bool wait_for_mail(const std::stop_token& stop);
  void write(StoreMailbox batch);
  void apply(const StoreMailbox& batch);
  void refused(StoreMailbox batch, const std::string& why);

  const Milliseconds commit_every_;
  const std::string options_json_, calibration_json_;
  MapStore store_;                 // of the writer's thread alone, as is
  std::uint64_t path_number_ = 0;  // of the stored path

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  StoreMailbox mailbox_;
  StoreState state_;
  std::size_t tiles_in_work_ = 0;  // taken out of the mailbox, neither committed nor refused yet
  std::uint64_t posted_ = 0;       // number of the newest mail ...
  std::uint64_t answered_ = 0;     // ... and of the newest that was committed or refused
  bool hurry_ = false;

  std::jthread thread_;  // last: it ends before anything it uses
};

}  // namespace flogmap
