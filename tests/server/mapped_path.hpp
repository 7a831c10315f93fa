// A pipeline run to its end, and what came of it.
#pragma once

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "server/pipeline.hpp"

namespace flogmap {

/// Keeps the path as a viewer would have it, and what was said of every frame.
class PathWitness final : public PipelineObserver {
 public:
  void map_begins(const MapBegin& /*begin*/) override {}
  void map_changed(std::uint64_t /*revision*/, const std::vector<TileUpdate>& updates) override {
    for (const TileUpdate& update : updates) tiles[update.index] = update.tile;
  }
  void path_grew(const std::vector<TrajectoryEntry>& entries) override {
    path.insert(path.end(), entries.begin(), entries.end());
  }
  void path_rewritten(const PathRewrite& rewrite) override {
    path = rewrite.path;
    level = rewrite.level;
    ++rewrites;
    if (!level.is_level()) levelled_by = rewrite.number;
  }
  void map_caught_up(std::uint64_t number) override { caught_up = number; }
  void frame_tracked(const TrackingReport& report) override { reports.push_back(report); }
  void pictures_taken(const PictureReport& /*report*/) override {}
  void status_changed(const StatusReport& /*report*/) override {}

  std::map<TileIndex, std::shared_ptr<const Tile>> tiles;
  std::vector<TrajectoryEntry> path;
  std::vector<TrackingReport> reports;
  int rewrites = 0;
  HandLevel level;
  std::atomic<std::uint64_t> levelled_by = 0;  // number of the rewrite that levelled the path
  std::atomic<std::uint64_t> caught_up = 0;
};

struct MappedPath {
  PathWitness witness;
  MapSnapshot map;
  StatusReport status;
};

/// Maps a source to its end; `batch`: the map is built anew once, at the end, else whenever there is time,
/// and then `level` is applied.
inline std::unique_ptr<MappedPath> map_path(std::unique_ptr<StereoSource> source,
                                            const FrontEndOptions& front_end_options,
                                            std::optional<GivenPoses> poses, const FlogOptions& flog,
                                            std::optional<LoopOptions> loops, bool batch = true,
                                            const std::optional<HandLevel>& level = std::nullopt) {
  auto mapped = std::make_unique<MappedPath>();
  FrontEnd front_end(front_end_options, Rectifier(*source->calibration()), std::move(poses), std::nullopt);
  MapIntegrator integrator(flog, front_end.camera(), front_end.max_disparity_px());
  PipelineOptions options;
  options.rate = 0;
  options.end_with_source = batch;
  options.loop_closure = std::move(loops);
  Pipeline pipeline(options, std::move(source), std::move(front_end), std::move(integrator), mapped->witness);
  pipeline.start();
  if (!batch) {
    while (pipeline.control().state() != SessionState::finished) std::this_thread::yield();
    if (level && pipeline.control().level(*level).outcome == ControlOutcome::done) {
      const PathWitness& witness = mapped->witness;
      while (witness.levelled_by == 0 || witness.caught_up < witness.levelled_by)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    pipeline.stop();
  }
  pipeline.wait();
  mapped->map = pipeline.integrator().snapshot();
  mapped->status = pipeline.status();
  return mapped;
}

}  // namespace flogmap
