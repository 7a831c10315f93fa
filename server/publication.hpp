// The values that the mapping side hands to the network side. Each is complete in itself and may be dropped
// in favour of a newer one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/pair_skew.hpp"
#include "camera/stereo_frame.hpp"
#include "mapping/hand_level.hpp"
#include "mapping/tile_update.hpp"
#include "mapping/view.hpp"
#include "server/stored_view.hpp"

namespace flogmap {

/// One frame's tracking in the world.
struct TrackingReport {
  std::int64_t timestamp_ns = 0;
  std::optional<SE3> world_from_camera;  // nothing while initialising or lost
  Tracking tracking;
  bool mapped = false;    // a view of this pose goes into the map
  double latency_ms = 0;  // from capture to the end of tracking
};

/// The newest rectified pair and its disparity; shared because several sessions may want it encoded.
struct PictureReport {
  std::int64_t timestamp_ns = 0;
  std::shared_ptr<const RectifiedFrame> frame;
  std::shared_ptr<const DisparityImage> disparity;
};

/// Upper bounds of the classes that the times of stages are counted in; longer ones are one class more.
inline constexpr std::array<double, 10> kTimeClassesMs{1, 2, 5, 10, 20, 50, 100, 200, 500, 1000};
using TimeCounts = std::array<std::uint64_t, kTimeClassesMs.size() + 1>;

struct StageReport {
  std::string stage;  // read, rectify, disparity, odometry, map
  double median_ms = 0;
  double p95_ms = 0;
  TimeCounts counts{};  // of this run
  double total_ms = 0;
};

/// A queue between two stages.
struct QueueReport {
  std::string queue;  // frames, views, loop
  std::uint64_t waiting = 0;
};

/// How the mapping does; published about twice a second.
struct StatusReport {
  double frames_per_s = 0;
  std::uint64_t frames = 0;
  std::uint64_t tracked = 0;
  std::uint64_t lost = 0;
  std::uint64_t mapped_views = 0;
  std::uint64_t waiting_views = 0;  // of stretches whose place in the map is not known yet
  std::uint64_t loops = 0;
  std::uint64_t dropped_frames = 0;  // live: the queue was full
  std::uint64_t skipped_frames = 0;  // could not be read
  std::vector<StageReport> stages;
  std::vector<QueueReport> queues;
  std::vector<std::string> warnings;        // in words, with what to do
  std::string alignment;                    // given, gravity, ground, none
  std::optional<PairSkew> skew;             // of sources that time both pictures
  std::optional<double> processor_celsius;  // where the system tells it
};

/// A map begins: fresh, reset, or continued from a store.
struct MapBegin {
  std::string epoch;  // 16 hex digits
  MapInfo info;
  StereoCamera camera;
  std::string reason;  // in words, for viewers: "started", "reset by operator", "seek"
  std::uint64_t revision = 0;
  std::vector<TileUpdate> tiles;            // of a continued map
  std::vector<TrajectoryEntry> trajectory;  // of a continued map
  std::vector<SharedView> views;            // of a continued map
  HandLevel level;                          // by hand, since the automatic start
};

}  // namespace flogmap
