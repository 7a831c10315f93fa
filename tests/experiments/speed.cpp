// How fast: the paper's two rows of timings.
#include <chrono>
#include <thread>

#include "camera/simulation/scene_json.hpp"
#include "mapping/flog/map_integrator.hpp"
#include "tests/experiments/experiments.hpp"

namespace flogmap::experiments {
namespace {

using Clock = std::chrono::steady_clock;

/// The room through a camera like the paper's: 320x240, 32 disparities.
Passage paper_sized() {
  Scene scene = load_scene("room");
  scene.camera = {210, 159.5, 119.5, 0.12, 320, 240};
  PassageOptions options;
  options.stereo.num_disparities = 32;
  options.max_frames = 390;  // as many views as the paper had
  return pass_scene(scene, options);
}

double mapping_ms(const Passage& passage) {
  FlogOptions options;
  options.row_step = 2;
  MapIntegrator integrator(options, passage.camera, passage.max_disparity_px);
  const auto start = Clock::now();
  for (const View& view : passage.views) integrator.integrate(view);
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count() /
         static_cast<double>(passage.views.size());
}

}  // namespace

Report speed(Workshop& /*workshop*/) {
  Report report;
  report.title = "How fast";
  report.question =
      "320x240, 32 disparities, 20x20x700 mm cells, three layers, every second row, 390 frames of the room, "
      "on the "
      "machine that wrote this page (" +
      std::to_string(std::thread::hardware_concurrency()) +
      " processors, shared with others). The paper's was an Athlon of 1.2 GHz. Rendering is not counted.";
  const Passage passage = paper_sized();
  const double view_ms = mapping_ms(passage);
  const double mapped = static_cast<double>(passage.views.size()) / static_cast<double>(passage.num_frames);
  const double without = passage.mean_times.disparity_ms + passage.mean_times.odometry_ms;
  const double with = without + mapped * view_ms;
  const auto count = [](std::int64_t n) { return std::to_string(n); };
  report.tables.push_back(
      {{"", "paper", "here"},
       {{"frames per second without mapping", "10", text(1000 / without, 1)},
        {"frames per second with mapping", "7.8", text(1000 / with, 1)},
        {"views mapped", "112 of 390",
         count(static_cast<std::int64_t>(passage.views.size())) + " of " + count(passage.num_frames)},
        {"mapping one view", "59 ms", text(view_ms, 1) + " ms"},
        {"mapping per processed frame", "17 ms", text(mapped * view_ms, 1) + " ms"},
        {"stereo per frame", "", text(passage.mean_times.disparity_ms, 1) + " ms"},
        {"motion per frame", "", text(passage.mean_times.odometry_ms, 1) + " ms"}}});
  report.findings = "Mapping one view takes " + text(59 / view_ms, 0) +
                    " times less than the paper's 59 ms and motion keeps up with any camera. Most of the "
                    "gain is twenty years of "
                    "processors, and semi-global matching, the default, spends much of it on better "
                    "disparities; docs/benchmarks-*.md "
                    "have the figures of a quiet machine.";
  return report;
}

}  // namespace flogmap::experiments
