// flogmap map: a recording in, a folder of map files out, as fast as possible.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "server/commands/commands.hpp"
#include "server/commands/interrupt_watcher.hpp"
#include "server/commands/mapping_session.hpp"
#include "server/commands/output_path.hpp"
#include "server/commands/progress_bar.hpp"
#include "server/export/map_files.hpp"
#include "server/pipeline.hpp"
#include "server/store/map_digest.hpp"
#include "server/views/view_keeper.hpp"

namespace flogmap {
namespace {

using Clock = std::chrono::steady_clock;

/// Keeps the path, shows how far it is. Called by the vision thread; the map itself is taken at the end.
class MapCollector final : public PipelineObserver {
 public:
  explicit MapCollector(std::int64_t num_frames) : progress_("mapping", num_frames) {}

  void map_begins(const MapBegin& begin) override { epoch_ = begin.epoch; }
  void map_changed(std::uint64_t /*revision*/, const std::vector<TileUpdate>& /*updates*/) override {}
  void view_mapped(const View& view) override {
    if (SharedView kept = keeper_.keep(view)) views_.push_back(std::move(kept));
  }
  void path_grew(const std::vector<TrajectoryEntry>& entries) override {
    path_.insert(path_.end(), entries.begin(), entries.end());
  }
  void path_rewritten(const PathRewrite& rewrite) override { path_ = rewrite.path; }
  void frame_tracked(const TrackingReport& report) override {
    ++frames_;
    lost_ += report.tracking.state == TrackingState::lost ? 1 : 0;
    progress_.show(frames_, lost_ > 0 ? std::to_string(lost_) + " lost" : "");
  }
  void pictures_taken(const PictureReport& /*report*/) override {}
  void status_changed(const StatusReport& report) override { alignment_ = report.alignment; }

  void finish() { progress_.finish(); }
  [[nodiscard]] const std::string& epoch() const { return epoch_; }
  [[nodiscard]] const std::string& alignment() const { return alignment_; }
  [[nodiscard]] const std::vector<TrajectoryEntry>& path() const { return path_; }
  [[nodiscard]] const std::vector<SharedView>& views() const { return views_; }

 private:
  ProgressBar progress_;
  std::string epoch_;
  std::string alignment_;
  std::vector<TrajectoryEntry> path_;
  ViewKeeper keeper_;  // map thread, as are the views until it has ended
  std::vector<SharedView> views_;
  std::int64_t frames_ = 0;
  std::int64_t lost_ = 0;
};

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// With given poses a frame is never lost; it is one that none is given for.
std::uint64_t frames_without_pose(const Options& options, const StatusReport& status) {
  return options.poses_file.empty() ? 0 : status.lost;
}

nlohmann::json statistics(const StatusReport& status, const StoredMap& map, std::uint64_t without_pose,
                          double wall_s) {
  nlohmann::json document = {{"frames", status.frames},
                             {"tracked", status.tracked},
                             {"lost", status.lost - without_pose},
                             {"without_pose", without_pose},
                             {"skipped", status.skipped_frames},
                             {"mapped_views", status.mapped_views},
                             {"waiting_views", status.waiting_views},
                             {"loops", status.loops},
                             {"wall_s", wall_s},
                             {"fps", wall_s > 0 ? static_cast<double>(status.frames) / wall_s : 0},
                             {"peak_rss_mb", peak_rss_mb()},
                             {"tiles", map.tiles.size()},
                             {"digest", map_digest(map)}};
  std::size_t cells = 0;
  for (const TileUpdate& tile : map.tiles) {
    for (const Cell& cell : tile.tile->cells) cells += cell.rays > 0 ? 1 : 0;
  }
  document["cells"] = cells;
  document["map_bytes"] = map.tiles.size() * kTileColumns * map.info.grid.num_layers() * sizeof(Cell);
  for (const StageReport& stage : status.stages) {
    document[stage.stage + "_median_ms"] = stage.median_ms;
    document[stage.stage + "_p95_ms"] = stage.p95_ms;
  }
  return document;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::trunc);
  file << text << '\n';
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

std::int64_t frames_to_map(const SourceInfo& info, int max_frames) {
  if (max_frames > 0) return max_frames;
  if (info.num_frames) return *info.num_frames;
  throw UsageError(info.spec + ": has no end; say how many frames to map with --max-frames N");
}

PipelineOptions batch_options(const Options& options, std::int64_t num_frames) {
  PipelineOptions batch;
  batch.rate = 0;
  batch.end_with_source = true;
  batch.max_frames = num_frames;
  batch.statistics_window = 1U << 20U;
  batch.loop_closure = loop_options(options);
  batch.max_view_bytes = static_cast<std::size_t>(options.view_memory_mb) << 20U;
  return batch;
}

StoredMap collected_map(const MapSnapshot& snapshot, const MapCollector& collector) {
  StoredMap map;
  map.epoch = collector.epoch();
  map.info = snapshot.info;
  map.revision = snapshot.revision;
  for (const auto& [index, tile] : snapshot.tiles) map.tiles.push_back({index, tile->revision, tile});
  map.trajectory = collector.path();
  map.views = collector.views();
  return map;
}

void print_summary(const StatusReport& status, std::uint64_t without_pose, double fps,
                   const std::string& alignment, const std::string& folder) {
  const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  std::printf(
      "%llu frames, %llu tracked, %llu lost, %llu skipped; %llu views mapped; %llu loops; %.1f frames/s; "
      "%s\n",
      count(status.frames), count(status.tracked), count(status.lost - without_pose),
      count(status.skipped_frames), count(status.mapped_views - status.waiting_views), count(status.loops),
      fps, alignment.c_str());
  if (without_pose > 0) {
    std::fprintf(stderr, "warning: %llu frames are not in the map: no pose is given within 5 ms of them\n",
                 count(without_pose));
  }
  if (status.waiting_views > 0) {
    std::fprintf(stderr,
                 "warning: %llu views are not in the map: their place was not recognised after a loss\n",
                 count(status.waiting_views));
  }
  for (const std::string& warning : status.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  std::printf("written to %s: map.flog, fused.png, path.png, layer_*.png, ros/, trajectory.tum, stats.json\n",
              folder.c_str());
}

int run_map(const Options& options, int max_frames, const std::string& options_json) {
  if (options.out_dir.empty()) throw UsageError("--out is missing; for instance --out /tmp/map");
  MappingSession session = open_session(options);
  make_output_folder(options.out_dir);
  limit_map_memory(options);
  const StereoCamera camera = session.front_end.camera();
  const std::int64_t num_frames = frames_to_map(session.source->info(), max_frames);
  MapCollector collector(num_frames);
  const auto start = Clock::now();
  Pipeline pipeline(batch_options(options, num_frames), std::move(session.source),
                    std::move(session.front_end), std::move(session.integrator), collector);
  {
    const InterruptWatcher ctrl_c([&] { pipeline.stop(); });  // what was mapped until then is written
    pipeline.start();
    pipeline.wait();
  }
  collector.finish();
  const double wall_s = std::chrono::duration<double>(Clock::now() - start).count();

  StoredMap map = collected_map(pipeline.integrator().snapshot(), collector);
  map.camera = camera;
  map.options_json = options_json;
  map.calibration_json = calibration_json(session.calibration, camera);
  write_map_folder(options.out_dir, map, options.serve.operators);
  const StatusReport status = pipeline.status();
  const std::uint64_t without_pose = frames_without_pose(options, status);
  const nlohmann::json document = statistics(status, map, without_pose, wall_s);
  write_text(std::filesystem::path(options.out_dir) / "stats.json", document.dump(2));
  print_summary(status, without_pose, document["fps"].get<double>(), collector.alignment(), options.out_dir);
  return 0;
}

}  // namespace

RunCommand add_map(CLI::App& app) {
  struct State {
    Options options;
    OptionTable table;
    int max_frames = 0;
  };
  auto state = std::make_shared<State>();
  add_source_options(state->table, state->options);
  add_mapping_options(state->table, state->options);
  state->table.text("out", "DIR", state->options.out_dir, "folder for the map's files; made if missing");
  state->table.integer("max-frames", "N", state->max_frames, 0, 1'000'000'000,
                       "stop after so many frames; 0 = all of the recording, one round of a simulated scene");
  state->table.attach(app);
  app.footer("Example: flogmap map --source euroc:/data/MH_01 --out /tmp/map");
  return [state] {
    state->table.apply(all_option_names());
    settle(state->options);
    return run_map(state->options, state->max_frames, state->table.effective().dump());
  };
}

}  // namespace flogmap
