// Dense stereo: from a rectified pair to the disparity of every pixel. FLOG.md section 8.
#pragma once

#include <memory>

#include "camera/stereo_camera.hpp"
#include "camera/stereo_frame.hpp"
#include "mapping/view.hpp"

namespace flogmap {

enum class MatcherKind {
  block,  // correlation with multiple windows, after reference [1]
  sgm,    // semi-global matching
};

struct StereoOptions {
  MatcherKind matcher = MatcherKind::sgm;
  int min_disparity = 0;                 // px; the far end of the range, may be negative for toed-in pairs
  int num_disparities = 0;               // px; 0 = as many as `nearest_m` needs
  double nearest_m = 0.5;                // m > 0; nothing nearer is expected
  double min_segment_fraction = 0.0015;  // of the image; smaller patches are removed, [0, 1)
  int num_threads = 0;                   // 0 = every core; the answer does not depend on it
};

/// Throws std::runtime_error naming field, value and what is allowed.
void check(const StereoOptions& options);

/// Disparities needed to see down to `nearest_m`: f t / nearest - min_disparity, rounded up to a multiple
/// of 16, at least 16, at most a fifth of the image's width and 256 (a street camera's 0.5 m would need 800).
int auto_num_disparities(const StereoCamera& camera, double nearest_m, int min_disparity);

/// Patches with fewer pixels than this are noise; for remove_small_segments().
int min_segment_px(const StereoOptions& options, const StereoCamera& camera);

/// Matches pair after pair; keeps its buffers between them. One thread calls it.
class DisparityMatcher {
 public:
  virtual ~DisparityMatcher() = default;

  /// Disparity of every pixel of the left picture, the whole width; NaN where there is no trustworthy match.
  /// Answers lie in [min_disparity, min_disparity + num_disparities). Both pictures have the same size, any
  /// size from 1 x 1. The same pair gives the same bits, whatever came before and on any number of threads.
  virtual DisparityImage match(const RectifiedFrame& pair) = 0;
};

/// `camera` serves the automatic number of disparities alone. Calls check().
std::unique_ptr<DisparityMatcher> make_matcher(const StereoOptions& options, const StereoCamera& camera);

}  // namespace flogmap
