#include "tests/experiments/passage.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "camera/simulated_source.hpp"
#include "camera/simulation/occupancy.hpp"
#include "camera/simulation/simulate_recording.hpp"
#include "camera/source_spec.hpp"

namespace flogmap::experiments {
namespace {

using TruePoses = std::map<std::int64_t, SE3>;

/// Odometry starts at the true first pose, so that both maps lie on one plan.
FrontEnd make_front_end(const StereoSource& source, const TruePoses& poses, const PassageOptions& options) {
  FrontEndOptions front_end;
  front_end.stereo = options.stereo;
  front_end.views.translation_m = options.view_translation_m;
  front_end.first_world_from_camera = poses.begin()->second;
  std::optional<GivenPoses> given;
  if (!options.with_odometry) given.emplace(poses, SE3::Identity());
  return {front_end, Rectifier(*source.calibration()), std::move(given), std::nullopt};
}

class Collector {
 public:
  Collector(const StereoSource& source, TruePoses poses, const PassageOptions& options)
      : poses_(std::move(poses)),
        front_end_(make_front_end(source, poses_, options)),
        every_frame_(options.every_frame) {
    passage_.camera = front_end_.camera();
    passage_.max_disparity_px = front_end_.max_disparity_px();
  }

  void take(const StereoFrame& frame) {
    FrontEndResult result = front_end_.process(frame);
    ++passage_.num_frames;
    passage_.truth.poses.push_back({frame.timestamp_ns, poses_.at(frame.timestamp_ns)});
    for (const TrajectoryEntry& entry : result.path) {
      passage_.estimate.poses.push_back({entry.timestamp_ns, entry.world_from_camera});
    }
    if (every_frame_) {
      result.views.clear();
      if (result.world_from_camera) {
        result.views.push_back({frame.timestamp_ns, *result.world_from_camera, *result.disparity, {}, 0});
      }
    }
    for (View& view : result.views) {
      passage_.true_poses.push_back(poses_.at(view.timestamp_ns));
      view.left = {};
      passage_.views.push_back(std::move(view));
    }
    passage_.mean_times.disparity_ms += result.times.disparity_ms;
    passage_.mean_times.odometry_ms += result.times.odometry_ms;
  }

  /// Of the frame just taken, if it became a view.
  void keep_exact(const Image<float>& inverse_depth) {
    if (passage_.exact.size() == passage_.views.size()) return;
    passage_.exact.push_back({inverse_depth});
    const double f_t = passage_.camera.focal_px * passage_.camera.baseline_m;
    for (float& d : passage_.exact.back().px.pixels) d = d > 0 ? static_cast<float>(f_t * d) : std::nanf("");
  }

  [[nodiscard]] const Passage& passage() const { return passage_; }

  Passage finish(std::vector<LayerTruth> layers, const std::vector<Image<std::uint8_t>>& seen_surfaces) {
    passage_.layers = std::move(layers);
    for (std::size_t k = 0; k < seen_surfaces.size(); ++k)
      passage_.layers[k].seen_surfaces = seen_surfaces[k];
    const auto n = static_cast<double>(std::max<std::int64_t>(1, passage_.num_frames));
    passage_.mean_times.disparity_ms /= n;
    passage_.mean_times.odometry_ms /= n;
    return std::move(passage_);
  }

 private:
  TruePoses poses_;
  FrontEnd front_end_;
  bool every_frame_;
  Passage passage_;
};

TruePoses true_poses(const SimulatedSource& source, std::int64_t num_frames) {
  TruePoses poses;
  const double period_ns = 1e9 / source.scene().rate_hz;
  const std::int64_t start_ns = source.info().first_timestamp_ns;
  for (std::int64_t i = 0; i < num_frames; ++i) {
    const std::int64_t time_ns = start_ns + std::llround(static_cast<double>(i) * period_ns);
    poses.emplace(time_ns, *source.true_pose(time_ns));
  }
  return poses;
}

std::vector<LayerTruth> true_layers(const Scene& scene, double time_s) {
  std::vector<LayerTruth> layers;
  const std::vector<double>& z = scene.truth.layer_bounds_m;
  for (std::size_t k = 0; k + 1 < z.size(); ++k) {
    const TruthLayer solid{true_occupancy(scene, z[k], z[k + 1], time_s), scene.truth.min_m.x(),
                           scene.truth.min_m.y(), scene.truth.cell_m};
    layers.push_back({solid, z[k], z[k + 1], std::nullopt});
  }
  return layers;
}

/// Where the layers lie.
Truth extent_of(const std::vector<LayerTruth>& layers) {
  const TruthLayer& first = layers.front().solid;
  Truth truth;
  truth.cell_m = first.cell_size_m;
  truth.min_m = {first.origin_x_m, first.origin_y_m};
  truth.max_m = truth.min_m + first.cell_size_m * Eigen::Vector2d(first.solid.width, first.solid.height);
  truth.layer_bounds_m = {layers.front().low_m};
  for (const LayerTruth& layer : layers) truth.layer_bounds_m.push_back(layer.high_m);
  return truth;
}

Image<float> inverse_depth(const DisparityImage& disparity, const StereoCamera& camera) {
  Image<float> inverse = disparity.px;
  const double f_t = camera.focal_px * camera.baseline_m;
  for (float& value : inverse.pixels) value = value > 0 ? static_cast<float>(value / f_t) : 0;
  return inverse;
}

}  // namespace

Passage pass_scene(const Scene& scene, const PassageOptions& options) {
  Scene bounded = scene;
  bounded.num_frames = recording_length(scene, {.seed = options.seed, .num_frames = options.max_frames});
  SimulatedSource source("sim:" + scene.name, bounded, options.seed);
  Collector collector(source, true_poses(source, bounded.num_frames), options);
  SeenCells seen(scene.truth, options.reach_m);
  while (const auto frame = source.next()) {
    seen.add(source.true_inverse_depth(), scene.camera, *source.true_pose(frame->timestamp_ns));
    collector.take(*frame);
    if (options.keep_exact) collector.keep_exact(source.true_inverse_depth());
  }
  const double end_s = static_cast<double>(bounded.num_frames - 1) / scene.rate_hz;
  return collector.finish(true_layers(scene, end_s), seen.surfaces());
}

Passage pass_recording(const std::filesystem::path& folder, const PassageOptions& options) {
  const auto source = open_source({.spec = "euroc:" + folder.string()});
  TruePoses poses;
  for (const TimedPose& pose : read_trajectory(folder / "groundtruth.tum").poses) {
    poses.emplace(pose.timestamp_ns, pose.world_from_camera);
  }
  Collector collector(*source, std::move(poses), options);
  for (std::int64_t i = 0; options.max_frames == 0 || i < options.max_frames; ++i) {
    const auto frame = source->next();
    if (!frame) break;
    collector.take(*frame);
  }
  std::vector<LayerTruth> layers;
  for (int k = 0; std::filesystem::exists(folder / "truth" / ("layer_" + std::to_string(k) + ".png")); ++k) {
    layers.push_back(read_layer_truth(folder / "truth", k));
  }
  SeenCells seen(extent_of(layers), options.reach_m);
  for (const View& view : at_true_poses(collector.passage())) {
    seen.add(inverse_depth(view.disparity, collector.passage().camera), collector.passage().camera,
             view.world_from_camera);
  }
  return collector.finish(std::move(layers), seen.surfaces());
}

std::vector<View> at_true_poses(const Passage& passage) {
  std::vector<View> views = passage.views;
  for (std::size_t i = 0; i < views.size(); ++i) views[i].world_from_camera = passage.true_poses[i];
  return views;
}

std::vector<View> with_exact_disparity(const Passage& passage) {
  std::vector<View> views = at_true_poses(passage);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].disparity = passage.exact[i];
  return views;
}

}  // namespace flogmap::experiments
