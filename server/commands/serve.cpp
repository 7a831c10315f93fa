// flogmap serve: maps and serves until SIGINT or SIGTERM; without a source, serves a stored map.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/commands/commands.hpp"
#include "server/commands/continued_map.hpp"
#include "server/commands/mapping_session.hpp"
#include "server/commands/serve_observer.hpp"
#include "server/commands/serving.hpp"
#include "server/commands/stored_control.hpp"
#include "server/hub.hpp"
#include "server/log.hpp"
#include "server/map_store.hpp"
#include "server/pipeline.hpp"

namespace flogmap {
namespace {

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

/// A map or store that cannot be used, or not with these options, is bad input.
template <typename Use>
auto as_input(const Use& use) {
  try {
    return use();
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

StoredMap load_input(const std::filesystem::path& file) {
  return as_input([&] { return load_settled_map(file); });
}

/// Every *.flog of a folder, by the name of its file.
void add_stored_maps(Hub& hub, const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".flog") continue;
    const std::string name = entry.path().stem().string();
    if (name == "live") {
      throw UsageError(entry.path().string() +
                       ": 'live' is the name of the map that is being made; rename it");
    }
    hub.add_stored_map(name, begin_of(load_input(entry.path()), "stored"));
  }
  if (error) throw UsageError("--maps " + folder + ": " + error.message());
}

int serve_stored(const Options& options, const HubInfo& info) {
  const StoredMap map = load_input(options.store);
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

/// Takes up the map that the store holds, if there is one.
ContinuedMap continue_stored(MapStore& store, const Options& options, MappingSession& session) {
  std::optional<StoredMap> stored = as_input([&] { return take_up(store, options.flog); });
  if (!stored) return {};
  session.integrator.restore(snapshot_of(*stored));
  // A robot is where it was switched off; a recording begins where it always does.
  const bool stays = session.source->info().live && !stored->trajectory.empty() && !options.first_pose;
  if (stays) {
    session.front_end.continue_from(stored->trajectory.back().world_from_camera);
    stored->level = {};  // it stands in the levelled world
  }
  return {stored->epoch, stored->tiles, stored->trajectory, stored->views, stored->level};
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
    MapStore file = as_input([&] { return MapStore(options.store); });
    pipeline_options.continued = continue_stored(file, options, session);
    store = std::make_unique<StoreWriter>(std::move(file), info.config_json, info.calibration_json);
  }
  pipeline_options.rate = options.as_fast_as_possible ? 0 : 1;
  pipeline_options.loop = options.source.loop;
  pipeline_options.loop_closure = loop_options(options);
  pipeline_options.keep_views = true;
  pipeline_options.max_view_bytes = static_cast<std::size_t>(options.view_memory_mb) << 20U;

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
