// flogmap simulate: renders a scene into a recording with its exact truth.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "camera/simulation/scene_json.hpp"
#include "camera/simulation/simulate_recording.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/progress_bar.hpp"
#include "server/option_table.hpp"

namespace flogmap {
namespace {

struct SimulateArguments {
  std::string scene, out;
  SimulationOptions options;
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

int simulate(const SimulateArguments& arguments) {
  const Scene scene = load_input(arguments.scene);
  if (arguments.out.empty()) throw UsageError("--out is missing; for instance --out /tmp/recording");
  const std::int64_t length = recording_length(scene, arguments.options);
  ProgressBar progress("rendering", length);
  simulate_recording(scene, arguments.out, arguments.options,
                     [&](std::int64_t done, std::int64_t) { progress.show(done, ""); });
  progress.finish();
  std::printf("%lld frames written to %s; map them: flogmap map --source euroc:%s --out /tmp/map\n",
              static_cast<long long>(length), arguments.out.c_str(), arguments.out.c_str());
  return 0;
}

}  // namespace

RunCommand add_simulate(CLI::App& app) {
  auto arguments = std::make_shared<SimulateArguments>();
  app.add_option("--scene", arguments->scene, "a scene that comes with the program, or a file of your own")
      ->type_name(scene_names() + "|FILE.json");
  app.add_option("--out", arguments->out, "folder of the new recording")->type_name("DIR");
  app.add_option("--frames", arguments->options.num_frames,
                 "0 = what the scene says, or one round of its path")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1'000'000}))
      ->type_name("N");
  app.add_option("--seed", arguments->options.seed, "of sensor noise and hand tremor")->type_name("N");
  app.add_option("--depth-views", arguments->options.num_depth_views, "views that come with exact depth")
      ->check(CLI::Range(0, 1'000'000))
      ->type_name("N");
  app.footer("Example: flogmap simulate --scene room --out /tmp/room");
  return [arguments] { return simulate(*arguments); };
}

}  // namespace flogmap
