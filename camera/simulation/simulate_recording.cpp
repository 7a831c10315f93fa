#include "camera/simulation/simulate_recording.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "camera/picture_files.hpp"
#include "camera/recording_writer.hpp"
#include "camera/simulated_source.hpp"
#include "camera/simulation/occupancy.hpp"
#include "camera/simulation/walk.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

void write_layer(const fs::path& file, const Image<std::uint8_t>& layer) {
  fs::create_directories(file.parent_path());
  if (!write_picture(file, {layer.width, layer.height, 1, 8, layer.pixels})) {
    throw std::runtime_error(file.string() + ": cannot be written; is the disk full?");
  }
}

void write_layer_description(const fs::path& file, const Truth& truth, std::size_t layer) {
  const Eigen::Vector2i size = truth_size(truth);
  nlohmann::ordered_json json;
  json["layer"] = layer;
  json["z"] = {truth.layer_bounds_m[layer], truth.layer_bounds_m[layer + 1]};
  json["origin"] = {truth.min_m.x(), truth.min_m.y()};
  json["cell"] = truth.cell_m;
  json["width"] = size.x();
  json["height"] = size.y();
  json["order"] = "row 0 = lowest y, column 0 = lowest x; origin = outer corner of cell (0,0)";
  json["meaning"] = "255 = a solid overlaps the cell box [x,x+cell) x [y,y+cell) x [z0,z1); 0 = free";
  std::ofstream out(file);
  out << json.dump(1) << '\n' << std::flush;
  if (!out) throw std::runtime_error(file.string() + ": cannot be written; is the disk full?");
}

void write_truth(const Scene& scene, const fs::path& folder, const SeenCells& seen, double end_s) {
  const std::vector<double>& bounds = scene.truth.layer_bounds_m;
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
    const std::string name = std::to_string(k);
    write_layer(folder / "truth" / ("layer_" + name + ".png"),
                true_occupancy(scene, bounds[k], bounds[k + 1], end_s));
    write_layer(folder / "truth" / ("seen_" + name + ".png"), seen.layers()[k]);
    write_layer(folder / "truth" / ("surface_" + name + ".png"), seen.surfaces()[k]);
    write_layer_description(folder / "truth" / ("layer_" + name + ".json"), scene.truth, k);
  }
}

void write_depth(const SimulatedSource& source, const fs::path& folder, std::int64_t timestamp_ns) {
  Image<float> image = source.true_depth();
  const std::string name = std::to_string(timestamp_ns) + ".pfm";
  write_pfm(folder / "depth" / name, image);
  const StereoCamera& camera = source.scene().camera;
  for (float& value : image.pixels) value = static_cast<float>(camera.focal_px * camera.baseline_m) / value;
  write_pfm(folder / "disparity" / name, image);
}

/// Takes back an unfinished recording, so that its name is free again.
class Unfinished {
 public:
  explicit Unfinished(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    was_empty_ = !fs::exists(folder_, error) || fs::is_empty(folder_, error);
  }
  ~Unfinished() {
    std::error_code error;
    if (finished_) return;
    if (!was_empty_) {
      for (const char* camera : {"cam0", "cam1"}) fs::remove(folder_ / "mav0" / camera / "data.csv", error);
      return;
    }
    for (const char* part : {"mav0", "truth", "depth", "disparity", "groundtruth.tum"})
      fs::remove_all(folder_ / part, error);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  void finished() { finished_ = true; }

 private:
  fs::path folder_;
  bool was_empty_ = false, finished_ = false;
};

}  // namespace

std::int64_t recording_length(const Scene& scene, const SimulationOptions& options) {
  if (options.num_frames > 0) return options.num_frames;
  if (scene.num_frames > 0) return scene.num_frames;
  const Walk walk(scene.path, scene.rate_hz, options.seed);
  return static_cast<std::int64_t>(std::ceil(walk.round_s() * scene.rate_hz)) + (scene.path.closed ? 1 : 0);
}

void simulate_recording(const Scene& scene, const fs::path& folder, const SimulationOptions& options,
                        const std::function<void(std::int64_t done, std::int64_t all)>& progress) {
  const std::int64_t all = recording_length(scene, options);
  Scene bounded = scene;
  bounded.num_frames = all;
  SimulatedSource source("sim:" + scene.name, bounded, options.seed);
  RecordingWriter::require_free(folder);
  Unfinished unfinished(folder);
  RecordingWriter writer(folder, *source.calibration(), {.compress = true, .rate_hz = scene.rate_hz});
  SeenCells seen(scene.truth);
  const std::int64_t depth_every = std::max<std::int64_t>(1, all / std::max(1, options.num_depth_views));
  const std::int64_t start_ns = source.info().first_timestamp_ns;
  double end_s = 0;
  while (const auto frame = source.next()) {
    const Eigen::Isometry3d pose = *source.true_pose(frame->timestamp_ns);
    writer.write(*frame, pose);
    seen.add(source.true_inverse_depth(), scene.camera, pose);
    if (options.num_depth_views > 0 && (writer.num_written() - 1) % depth_every == 0) {
      write_depth(source, folder, frame->timestamp_ns);
    }
    end_s = 1e-9 * static_cast<double>(frame->timestamp_ns - start_ns);
    if (progress) progress(writer.num_written() + source.skipped().count, all);
  }
  write_truth(scene, folder, seen, end_s);
  unfinished.finished();
}

}  // namespace flogmap
