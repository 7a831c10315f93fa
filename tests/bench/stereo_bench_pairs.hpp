// Pairs with known disparity, and real ones without, from $FLOGMAP_DATA.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "camera/stereo_frame.hpp"

namespace flogmap {

struct BenchPair {
  std::string name{};
  RectifiedFrame frame{};
  int num_disparities = 0;
  StereoCamera camera{};          // focal_px = 0: unknown
  Image<float> truth{};           // disparity of the left picture, NaN unknown; empty: none
  Image<std::uint8_t> visible{};  // 1 where the right picture sees the point too
};

/// Middlebury (2001, 2003), the rendered views with depth, and one frame each of EuRoC MH_01 (752x480) and
/// KITTI. Throws std::runtime_error naming a folder that is missing.
std::vector<BenchPair> load_bench_pairs(const std::filesystem::path& data);

}  // namespace flogmap
