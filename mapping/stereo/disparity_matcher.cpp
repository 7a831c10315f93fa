#include "mapping/stereo/disparity_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mapping/stereo/block_matcher.hpp"
#include "mapping/stereo/sgm_matcher.hpp"

namespace flogmap {
namespace {

constexpr int kStep = 16;  // numbers of disparities are multiples of it
constexpr int kMaxDisparities = 256;

int round_up(double value) { return static_cast<int>(std::ceil(value / kStep)) * kStep; }

void require(bool allowed, const std::string& field, double value, const std::string& what) {
  if (allowed) return;
  throw std::runtime_error("stereo: " + field + " must be " + what + ", got " + std::to_string(value));
}

}  // namespace

void check(const StereoOptions& options) {
  require(options.min_disparity >= -kMaxDisparities && options.min_disparity <= 4 * kMaxDisparities,
          "min-disparity", options.min_disparity, "in [-256, 1024]");
  require(options.num_disparities >= 0 && options.num_disparities <= kMaxDisparities, "num-disparities",
          options.num_disparities, "in [1, 256], or auto");
  require(options.nearest_m > 0, "nearest", options.nearest_m, "> 0 metres");
  require(options.min_segment_fraction >= 0 && options.min_segment_fraction < 1, "min-segment-fraction",
          options.min_segment_fraction, "in [0, 1)");
  require(options.num_threads >= 0, "threads", options.num_threads, ">= 0");
}

int auto_num_disparities(const StereoCamera& camera, double nearest_m, int min_disparity) {
  const double nearest_px = camera.focal_px * camera.baseline_m / nearest_m;
  const int most = std::min(kMaxDisparities, round_up(camera.width_px / 5.0));
  return std::clamp(round_up(std::min(nearest_px, 1e6) - min_disparity), kStep, std::max(most, kStep));
}

int min_segment_px(const StereoOptions& options, const StereoCamera& camera) {
  return static_cast<int>(std::lround(options.min_segment_fraction * camera.width_px * camera.height_px));
}

std::unique_ptr<DisparityMatcher> make_matcher(const StereoOptions& options, const StereoCamera& camera) {
  check(options);
  StereoOptions complete = options;
  if (complete.num_disparities == 0) {
    complete.num_disparities = auto_num_disparities(camera, options.nearest_m, options.min_disparity);
  }
  complete.num_disparities = (complete.num_disparities + kStep - 1) / kStep * kStep;
  const MatchKernels kernels = match_kernels(complete.num_disparities);
  return complete.matcher == MatcherKind::sgm ? make_sgm_matcher(complete, kernels)
                                              : make_block_matcher(complete, kernels);
}

}  // namespace flogmap
