// flogmap simulate: renders a scene into a recording with its exact truth.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "camera/recording_writer.hpp"
#include "camera/simulation/scene_json.hpp"
#include "camera/simulation/simulate_recording.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/interrupt_watcher.hpp"
#include "server/commands/output_path.hpp"
#include "server/commands/progress_bar.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

constexpr int kMostFrames = 1'000'000;

struct SimulateArguments {
  std::string scene, out;
  int num_frames = 0;
  SimulationOptions options;
  OptionTable table;
};

std::string scene_names() {
  std::string names;
  for (const std::string& name : built_in_scenes()) names += (names.empty() ? "" : "|") + name;
  return names;
}

Scene load_input(const std::string& name) {
  if (name.empty()) throw UsageError("--scene is missing; allowed: " + scene_names() + "|FILE.json");
  try {
    return load_scene(name);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

/// A folder that cannot be made or holds a recording is bad input.
void check_output(const std::string& folder) {
  try {
    RecordingWriter::require_free(folder);
  } catch (const std::exception& error) {
    throw UsageError(std::string("--out ") + error.what());
  }
  make_output_folder(folder);
}

int simulate(const SimulateArguments& arguments) {
  const Scene scene = load_input(arguments.scene);
  if (arguments.out.empty()) throw UsageError("--out is missing; for instance --out /tmp/recording");
  check_output(arguments.out);
  const std::int64_t length = recording_length(scene, arguments.options);
  ProgressBar progress("rendering", length);
  std::atomic<bool> interrupted = false;
  const InterruptWatcher ctrl_c([&] { interrupted = true; });
  simulate_recording(scene, arguments.out, arguments.options, [&](std::int64_t done, std::int64_t all) {
    if (interrupted) {
      progress.finish();
      throw std::runtime_error("interrupted after " + std::to_string(done) + " of " + std::to_string(all) +
                               " frames; without its end the recording has no truth and is not kept");
    }
    progress.show(done, "");
  });
  progress.finish();
  std::printf("%lld frames written to %s; map them: flogmap map --source euroc:%s --out /tmp/map\n",
              static_cast<long long>(length), arguments.out.c_str(), arguments.out.c_str());
  return 0;
}

}  // namespace

RunCommand add_simulate(CLI::App& app) {
  auto state = std::make_shared<SimulateArguments>();
  OptionTable& table = state->table;
  table.text("scene", scene_names() + "|FILE.json", state->scene,
             "a scene that comes with the program, or a file of your own");
  table.text("out", "DIR", state->out, "folder of the new recording");
  table.integer("frames", "N", state->num_frames, 0, kMostFrames,
                "0 = what the scene says, or one round of its path");
  add_seed_option(table, state->options.seed, "of sensor noise and hand tremor");
  table.integer("depth-views", "N", state->options.num_depth_views, 0, kMostFrames,
                "views that come with exact depth");
  table.attach(app);
  app.footer("Example: flogmap simulate --scene room --out /tmp/room");
  return [state] {
    state->table.apply(all_option_names());
    state->options.num_frames = state->num_frames;
    return simulate(*state);
  };
}

}  // namespace flogmap
