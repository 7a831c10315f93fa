// Sub-pixel disparity from the brightness of both pictures.
#pragma once

#include "camera/stereo_frame.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// Fits the disparities of a matcher to the brightness of both pictures. A matcher compares at whole pixels,
/// and what is interpolated between its costs is drawn towards whole numbers; brightness has no such
/// preference.
///
/// Each answer becomes the mean of its neighbours on the same surface, then moves by the shift that explains
/// the remaining difference of brightness best (one Gauss-Newton step of Lucas and Kanade's method, along the
/// row, with a brightness offset of its own in every window). Keeps its buffers between pictures.
class SubpixelFit {
 public:
  /// No answer becomes less than `least_px`.
  SubpixelFit(float least_px, int num_threads) : least_px_(least_px), num_threads_(num_threads) {}

  /// Answers of plain surfaces stay what their neighbours say, NaN stays NaN. The same pair gives the same
  /// bits on any number of threads. `disparity` has the size of both pictures.
  void refine(DisparityImage& disparity, const RectifiedFrame& pair);

 private:
  void smooth(Image<float>& disparity);
  void compare(const Image<float>& disparity, const RectifiedFrame& pair);
  void shift(Image<float>& disparity) const;

  float least_px_;
  int num_threads_;
  Image<float> along_;  // smoothed along the rows
  Image<float>
      gradient_;  // of the brightness along the row, mean of both pictures; 0 where nothing is compared
  Image<float> difference_;  // left minus right at the disparity; 0 where nothing is compared
};

}  // namespace flogmap
