// The map thread: takes views and corrections, tells of changed tiles.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "mapping/map_builder.hpp"
#include "server/bounded_queue.hpp"
#include "server/pipeline_observer.hpp"
#include "server/stage_statistics.hpp"

namespace flogmap {

/// run() and map() belong to the map thread, everything else to the thread that sees the frames.
class MapStage {
 public:
  /// `batch`: the map catches up with corrections once, at the end, else whenever no view waits. `ending`
  /// says that the server shuts down: then catching up is cut short.
  MapStage(MapBuilder builder, PipelineObserver& observer, StageStatistics& statistics, bool batch,
           std::function<bool()> ending);

  void integrate(View view);
  /// `number`: of the rewritten path, told again by map_caught_up().
  void correct(PathCorrection correction, std::uint64_t number);

  /// Another map begins, the first one with what the builder holds. Returns when it has begun, so that no
  /// pose of it comes too early and no tile of the one before too late. Info and revision of `map` are filled
  /// in.
  void begin(MapBegin map);

  /// Returns when everything so far is in the map. Corrections as well, unless they are for the end: in
  /// batch, and while the server shuts down.
  void wait_for_rest();

  void run();
  void close() { items_.close(); }
  void abandon() { items_.abandon(); }

  /// Views that wait for their place. From any thread.
  [[nodiscard]] std::uint64_t num_waiting() const { return num_waiting_; }
  /// Views that wait for this stage. From any thread.
  [[nodiscard]] std::size_t num_queued() const { return items_.size(); }

  /// Why the map cannot be levelled, in words; empty if it can be. From any thread.
  [[nodiscard]] std::string why_not_levelled() const;

  [[nodiscard]] const MapIntegrator& map() const { return builder_.map(); }

 private:
  struct Item {
    std::optional<View> view;  // as odometry has it; or ...
    std::optional<PathCorrection> correction;
    std::uint64_t number = 0;                     // of the correction
    std::optional<MapBegin> begin;                // ... begin this map; or ...
    bool rest = false;                            // ... catch up; then ...
    std::shared_ptr<std::promise<void>> reached;  // ... of the last two: open this
  };

  void wait_for(Item item);
  std::optional<Item> next();
  void take_in(Item& item);
  void take_in(View& view);
  void begin_now(MapBegin& map);
  void catch_up();

  MapBuilder builder_;
  PipelineObserver& observer_;
  StageStatistics& statistics_;
  const bool batch_;
  const std::function<bool()> ending_;
  bool begun_ = false;
  BoundedQueue<Item> items_;
  std::atomic<std::uint64_t> num_waiting_ = 0;
  std::atomic<bool> whole_;
  std::uint64_t newest_number_ = 0;
};

}  // namespace flogmap
