// What the chain (rectify, match, filter, track, select) makes of a scene or a recording, kept, so that many
// maps can be made of the same views.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "camera/simulation/scene.hpp"
#include "mapping/front_end.hpp"
#include "mapping/map_truth.hpp"
#include "mapping/odometry/trajectory_error.hpp"
#include "mapping/view.hpp"

namespace flogmap::experiments {

struct PassageOptions {
  StereoOptions stereo;
  double view_translation_m = 0.08;  // 4 cells of 20 mm
  bool every_frame = false;          // a view is kept of every frame instead, moved or not
  bool keep_exact = false;           // of a scene: exact disparities beside the measured ones
  bool with_odometry = true;         // else the views stand where the truth says
  std::int64_t max_frames = 0;       // 0: all, or one round of a scene
  double reach_m = 5;                // surfaces farther than this do not count as seen
  std::uint64_t seed = 1;
};

/// A camera's way through a world, with the truth beside it.
struct Passage {
  StereoCamera camera;
  double max_disparity_px = 0;
  std::vector<View> views;            // estimated poses, the first being the true one
  std::vector<SE3> true_poses;        // of the views: world_from_camera
  std::vector<DisparityImage> exact;  // of the views, if asked for: what a perfect matcher would say
  Trajectory estimate, truth;         // of every tracked frame; of every frame
  std::vector<LayerTruth> layers;
  std::int64_t num_frames = 0;
  StageTimes mean_times;
};

/// Renders the scene and takes it through the chain. The truth is that of the scene's layers when the last
/// frame is taken, with what the camera could see.
[[nodiscard]] Passage pass_scene(const Scene& scene, const PassageOptions& options);

/// The same with a recording that has groundtruth.tum (rectified left camera) and truth/layer_<k>. Where a
/// surface could be seen is taken from the measured depths of its views at their true poses.
[[nodiscard]] Passage pass_recording(const std::filesystem::path& folder, const PassageOptions& options);

/// The same views where they truly were.
[[nodiscard]] std::vector<View> at_true_poses(const Passage& passage);

/// And with exact disparities instead of measured ones.
[[nodiscard]] std::vector<View> with_exact_disparity(const Passage& passage);

}  // namespace flogmap::experiments
