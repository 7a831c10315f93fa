#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "camera/simulation/scene.hpp"

namespace flogmap {

struct SimulationOptions {
  std::uint64_t seed = 1;
  std::int64_t num_frames = 0;  // 0: what the scene says, or one round of its path
  int num_depth_views = 10;     // so many views, evenly spread, come with exact depth and disparity
};

/// Renders a scene into a recording with its truth:
///   mav0/...                    pictures, calibration and exact poses, EuRoC layout; groundtruth.tum
///   truth/layer_<k>.png, .json  occupancy at the end of the recording
///   truth/seen_<k>.png, surface_<k>.png  what the camera could see of a layer; and where it saw a surface
///   depth/<time>.pfm            Z of the left camera [m];  disparity/<time>.pfm [px]
/// `progress` is told frames done and in all. Throws std::runtime_error naming what cannot be written, and
/// what `progress` throws: then nothing of the recording stays in a folder that was new or empty, and of any
/// other only pictures that no list names.
void simulate_recording(const Scene& scene, const std::filesystem::path& folder,
                        const SimulationOptions& options,
                        const std::function<void(std::int64_t done, std::int64_t all)>& progress);

/// How many frames that will be.
[[nodiscard]] std::int64_t recording_length(const Scene& scene, const SimulationOptions& options);

}  // namespace flogmap
