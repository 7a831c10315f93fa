// The whole chain as `flogmap map` runs it, threads included, on frames in memory: frames per second, CPU
// time and the stages' medians. Prints a table and writes build/bench/chain.json (path in the first
// argument).
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "camera/simulated_source.hpp"
#include "camera/simulation/scene_json.hpp"
#include "camera/source_spec.hpp"
#include "server/pipeline.hpp"
#include "tests/support/memory_source.hpp"

namespace flogmap {
namespace {

constexpr std::size_t kFrames = 110;

class Deaf final : public PipelineObserver {
 public:
  void map_begins(const MapBegin& /*begin*/) override {}
  void map_changed(std::uint64_t /*revision*/, const std::vector<TileUpdate>& /*updates*/) override {}
  void path_grew(const std::vector<TrajectoryEntry>& /*entries*/) override {}
  void frame_tracked(const TrackingReport& /*report*/) override {}
  void pictures_taken(const PictureReport& /*report*/) override {}
  void status_changed(const StatusReport& /*report*/) override {}
};

struct Run {
  double fps = 0;
  double cpu_ms_per_frame = 0;
  StatusReport status;
};

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The simulated room through a camera of this size and the same field of view.
std::unique_ptr<StereoSource> room(int width_px, int height_px) {
  Scene scene = load_scene("room");
  const double scale = static_cast<double>(width_px) / scene.camera.width_px;
  scene.camera.focal_px *= scale;
  scene.camera.cx_px = (width_px - 1) / 2.0;
  scene.camera.cy_px = (height_px - 1) / 2.0;
  scene.camera.width_px = width_px;
  scene.camera.height_px = height_px;
  return std::make_unique<SimulatedSource>("sim:room", scene, 1);
}

Run run(StereoSource& recording, const FrontEndOptions& options, const FlogOptions& flog) {
  auto source = std::make_unique<MemorySource>(record_frames(recording, kFrames));
  FrontEnd front_end(options, Rectifier(*source->calibration()), std::nullopt, std::nullopt);
  MapIntegrator integrator(flog, front_end.camera(), front_end.max_disparity_px());
  PipelineOptions pipeline_options;
  pipeline_options.rate = 0;
  pipeline_options.end_with_source = true;
  Deaf observer;
  Pipeline pipeline(pipeline_options, std::move(source), std::move(front_end), std::move(integrator),
                    observer);
  const double cpu_before = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  pipeline.start();
  pipeline.wait();
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Run result;
  result.status = pipeline.status();
  const auto frames = static_cast<double>(result.status.frames);
  result.fps = frames / wall_s;
  result.cpu_ms_per_frame = (cpu_seconds() - cpu_before) * 1000 / frames;
  return result;
}

void print(const char* name, const Run& result) {
  std::printf("%-22s %7.1f frames/s %8.1f ms CPU a frame   tracked %llu of %llu, %llu views mapped\n", name,
              result.fps, result.cpu_ms_per_frame, static_cast<unsigned long long>(result.status.tracked),
              static_cast<unsigned long long>(result.status.frames),
              static_cast<unsigned long long>(result.status.mapped_views));
  for (const StageReport& stage : result.status.stages) {
    std::printf("    %-10s median %6.2f ms   p95 %6.2f ms\n", stage.stage.c_str(), stage.median_ms,
                stage.p95_ms);
  }
}

int bench(const std::filesystem::path& json_file) {
  const char* data = std::getenv("FLOGMAP_DATA");
  const std::unique_ptr<StereoSource> large =
      data != nullptr ? open_source({.spec = "euroc:" + std::string(data) + "/euroc_mh01_10hz",
                                     .calibration_file = {},
                                     .loop = false,
                                     .seed = 1})
                      : room(752, 480);
  const Run wide = run(*large, {}, {});
  print("752x480", wide);
  // As in the paper: 320x240, 32 disparities, every second row.
  FrontEndOptions paper;
  paper.stereo.num_disparities = 32;
  FlogOptions paper_map;
  paper_map.row_step = 2;
  const Run small = run(*room(320, 240), paper, paper_map);
  print("320x240, 32 disparities", small);

  nlohmann::json document = {{"fps_752x480", wide.fps}, {"cpu_ms_per_frame", wide.cpu_ms_per_frame}};
  for (const StageReport& stage : wide.status.stages) document[stage.stage + "_ms"] = stage.median_ms;
  document["fps_320x240"] = small.fps;
  std::filesystem::create_directories(json_file.parent_path());
  std::ofstream(json_file) << document.dump(2) << '\n';
  return 0;
}

}  // namespace
}  // namespace flogmap

int main(int argc, char** argv) { return flogmap::bench(argc > 1 ? argv[1] : "build/bench/chain.json"); }
