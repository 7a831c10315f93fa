// flogmap serve: maps and serves until SIGINT or SIGTERM; without a source, serves a stored map.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/commands/commands.hpp"
#include "server/commands/mapping_session.hpp"
#include "server/commands/serving.hpp"
#include "server/commands/stored_control.hpp"
#include "server/hub.hpp"
#include "server/log.hpp"
#include "server/map_store.hpp"
#include "server/pipeline.hpp"
#include "server/store/store_writer.hpp"
#include "server/views/view_keeper.hpp"

namespace flogmap {
namespace {

/// Hands everything on to those who show it and to those who keep it.
class ServeObserver final : public PipelineObserver {
 public:
  void connect(Hub* hub, StoreWriter* store) {
    hub_ = hub;
    store_ = store;
  }

  void map_begins(const MapBegin& begin) override {
    path_ = begin.trajectory;
    keeper_.begin(begin.views);
    if (store_ != nullptr) store_->begin(begin);
    hub_->begin(begin);
  }
  void map_changed(std::uint64_t revision, const std::vector<TileUpdate>& updates) override {
    if (store_ != nullptr) store_->publish(updates);
    hub_->publish(revision, updates);
  }
  void view_mapped(const View& view) override {
    const SharedView kept = keeper_.keep(view);
    if (!kept) return;
    if (store_ != nullptr) store_->put_view(kept);
    hub_->publish_view(kept);
  }
  void path_grew(const std::vector<TrajectoryEntry>& entries) override {
    path_.insert(path_.end(), entries.begin(), entries.end());
    if (store_ != nullptr) store_->append_trajectory(entries);
    // The hub appends the poses of tracking reports itself. Only frames of the first seconds get theirs
    // later, all at once, when it is decided which way is up.
    if (entries.size() > 1 || entries.back().timestamp_ns != tracked_ns_) {
      hub_->rewrite_trajectory(path_, "levelled");
    }
  }
  void path_rewritten(const std::vector<TrajectoryEntry>& path, const std::string& reason) override {
    path_ = path;
    if (store_ != nullptr) store_->rewrite_trajectory(path_);
    hub_->rewrite_trajectory(path_, reason);
  }
  void map_levelled(const HandLevel& level) override {
    if (store_ != nullptr) store_->put_level(level);
  }
  void frame_tracked(const TrackingReport& report) override {
    if (report.world_from_camera) tracked_ns_ = report.timestamp_ns;
    hub_->publish_tracking(report);
  }
  void pictures_taken(const PictureReport& report) override { hub_->publish_pictures(report); }
  void status_changed(const StatusReport& report) override {
    StatusReport with_store = report;
    if (store_ != nullptr) {
      const StoreState state = store_->state();
      if (!state.ok) with_store.warnings.push_back(state.problem);
    }
    hub_->publish_status(with_store);
  }

 private:
  Hub* hub_ = nullptr;
  StoreWriter* store_ = nullptr;
  std::vector<TrajectoryEntry> path_;
  ViewKeeper keeper_;             // map thread
  std::int64_t tracked_ns_ = -1;  // newest frame whose pose the hub has
};

MapBegin begin_of(const StoredMap& map, const std::string& reason) {
  return {.epoch = map.epoch,
          .info = map.info,
          .camera = map.camera,
          .reason = reason,
          .revision = map.revision,
          .tiles = map.tiles,
          .trajectory = map.trajectory,
          .views = map.views,
          .level = map.level};
}

/// Every *.flog of a folder, by the name of its file.
void add_stored_maps(Hub& hub, const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".flog") continue;
    hub.add_stored_map(entry.path().stem().string(), begin_of(load_map(entry.path()), "stored"));
  }
  if (error) throw UsageError("--maps " + folder + ": " + error.message());
}

int serve_stored(const Options& options, const HubInfo& info) {
  const StoredMap map = load_map(options.store);
  StoredControl control(options.store);
  HubInfo with_calibration = info;
  with_calibration.calibration_json = map.calibration_json;
  Hub hub(options.serve, control, with_calibration);
  add_stored_maps(hub, options.maps_dir);
  hub.begin(begin_of(map, "stored"));
  hub.drain_on_signals();
  announce(options, hub.port(), "Serving the stored map " + options.store);
  hub.run();
  return 0;
}

/// After a kill, viewers may have seen more than was stored: a second, or, where the disk was full, all since
/// the start. A revision far above all that they can know makes them take every tile anew. The clock's
/// milliseconds are above those of any earlier start, stored or not.
void outrank_what_viewers_know(StoredMap& map) {
  constexpr std::uint64_t kFarAbove = 1'000'000;
  const auto now_ms = std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  map.revision = std::max(map.revision + kFarAbove, static_cast<std::uint64_t>(now_ms.count()));
  for (TileUpdate& update : map.tiles) {
    update.tile = std::make_shared<const Tile>(Tile{update.tile->cells, map.revision});
    update.revision = map.revision;
  }
}

/// Stored now, while nothing is mapped: later it would hold up the tiles of the last second. A disk that
/// refuses it does not keep anybody from mapping; the store's writer tries again and says so.
void store_outranked(MapStore& store, const StoredMap& map) {
  try {
    store.begin(map);
    store.commit();
  } catch (const std::runtime_error&) {
    store.rollback();
  }
}

/// Takes up the map that the store holds, if there is one.
ContinuedMap continue_stored(MapStore& store, const Options& options, MappingSession& session) {
  std::optional<StoredMap> stored = store.load();
  if (!stored) return {};
  check_same_grid(options.store, stored->info.grid, options.flog.grid);
  if (!store.ended_cleanly()) {
    outrank_what_viewers_know(*stored);
    store_outranked(store, *stored);
  }
  session.integrator.restore(snapshot_of(*stored));
  // A robot is where it was switched off; a recording begins where it always does.
  const bool stays = session.source->info().live && !stored->trajectory.empty() && !options.first_pose;
  if (stays) {
    session.front_end.continue_from(stored->trajectory.back().world_from_camera);
    stored->level = {};  // it stands in the levelled world
  }
  return {stored->epoch, stored->tiles, stored->trajectory, stored->views, stored->level};
}

/// A store that cannot be used is bad input.
MapStore open_store(const std::string& file) {
  try {
    return MapStore(file);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

void log_failure(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    log_event(LogLevel::error, "the mapping failed", {{"error", error.what()}});
  }
}

/// Maps and serves until the hub is told to end; returns why the mapping failed, if it did.
template <typename Announce>
std::exception_ptr serve_until_end(Pipeline& pipeline, Hub& hub, const Announce& announce_it) {
  std::exception_ptr failure;
  pipeline.start();
  std::jthread watch([&] {
    try {
      pipeline.wait();
    } catch (...) {
      failure = std::current_exception();
      log_failure(failure);
      hub.drain("the mapping failed");
    }
  });
  announce_it();
  hub.run();
  pipeline.stop();
  watch.join();  // it may still be writing down why
  return failure;
}

int serve_source(const Options& options, HubInfo info) {
  MappingSession session = open_session(options);
  info.calibration_json = calibration_json(session.calibration, session.front_end.camera());
  std::unique_ptr<StoreWriter> store;
  PipelineOptions pipeline_options;
  if (!options.store.empty()) {
    MapStore file = open_store(options.store);
    pipeline_options.continued = continue_stored(file, options, session);
    store = std::make_unique<StoreWriter>(std::move(file), info.config_json, info.calibration_json);
  }
  pipeline_options.rate = options.as_fast_as_possible ? 0 : 1;
  pipeline_options.loop = options.source.loop;
  pipeline_options.loop_closure = loop_options(options);
  pipeline_options.keep_views = true;

  ServeObserver observer;
  Pipeline pipeline(pipeline_options, std::move(session.source), std::move(session.front_end),
                    std::move(session.integrator), observer);
  Hub hub(options.serve, pipeline.control(), info);
  add_stored_maps(hub, options.maps_dir);
  observer.connect(&hub, store.get());
  hub.drain_on_signals();
  const std::exception_ptr failure = serve_until_end(
      pipeline, hub, [&] { announce(options, hub.port(), "Mapping " + options.source.spec); });
  if (store) {
    const StoreState saved = store->flush();
    log_event(saved.ok ? LogLevel::info : LogLevel::error, "store",
              {{"file", options.store},
               {"revision", static_cast<std::int64_t>(saved.committed_revision)},
               {"problem", saved.problem}});
    if (!saved.ok && !failure) throw std::runtime_error(saved.problem);
  }
  if (failure) std::rethrow_exception(failure);
  return 0;
}

}  // namespace

RunCommand add_serve(CLI::App& app) {
  struct State {
    Options options;
    OptionTable table;
  };
  auto state = std::make_shared<State>();
  add_source_options(state->table, state->options);
  add_mapping_options(state->table, state->options);
  add_serve_options(state->table, state->options);
  state->table.attach(app);
  app.footer(
      "Examples: flogmap serve --source sim:room\n"
      "          flogmap serve --source euroc:/data/MH_01 --store map.flog --listen 127.0.0.1:9000");
  return [state] {
    Options& options = state->options;
    state->table.apply(all_option_names());
    settle(options);
    if (options.source.spec.empty() && options.store.empty()) {
      throw UsageError("say what to serve: --source SPEC to map, --store FILE for a stored map, or both");
    }
    settle_serving(options);
    HubInfo info;
    info.config_json = state->table.effective().dump();
    info.version = FLOGMAP_VERSION;
    limit_map_memory(options);
    const LogScope log(options.log);
    return options.source.spec.empty() ? serve_stored(options, info) : serve_source(options, info);
  };
}

}  // namespace flogmap
