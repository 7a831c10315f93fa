#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/publication.hpp"

namespace flogmap {

/// Where the mapping's threads leave what they have to say and the network thread picks it up. Bounded by
/// merging: one entry per tile, the newest of each report; only the trajectory grows, by one entry a frame.
class Mailbox {
 public:
  struct Rewrite {
    std::vector<TrajectoryEntry> trajectory;
    std::string reason;
  };

  /// In the order in which they are to be taken in.
  struct Contents {
    std::optional<MapBegin> begin;
    std::uint64_t revision = 0;
    std::map<TileIndex, TileUpdate> tiles;
    std::optional<Rewrite> rewrite;
    std::vector<TrajectoryEntry> appended;
    std::vector<SharedView> views;
    std::optional<TrackingReport> tracking;
    std::optional<PictureReport> pictures;
    std::optional<StatusReport> status;
    std::optional<std::string> calibration_json;
    std::optional<std::string> drain_reason;
  };

  // Each returns true if nobody has been woken for the contents yet: then wake the network thread.
  bool begin(MapBegin map);
  bool publish(std::uint64_t revision, std::vector<TileUpdate> tiles);
  bool publish_view(SharedView view);
  bool publish_tracking(TrackingReport report);
  bool publish_pictures(PictureReport report);
  bool publish_status(StatusReport report);
  bool rewrite_trajectory(std::vector<TrajectoryEntry> trajectory, std::string reason);
  bool set_calibration(std::string calibration_json);
  bool drain(std::string reason);

  /// Everything since the last call.
  Contents take();

 private:
  /// Locks, lets `merge` change the contents, and says whether to wake.
  template <typename Merge>
  bool merge(Merge merge_into);

  std::mutex mutex_;
  Contents contents_;
  bool woken_ = false;
};

}  // namespace flogmap
