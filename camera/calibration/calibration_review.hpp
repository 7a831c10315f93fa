#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "camera/calibration/stereo_calibration.hpp"
#include "camera/stereo_frame.hpp"

namespace flogmap {

/// How well a calibration suits the pictures that it came with.
struct CalibrationReview {
  std::size_t num_matches = 0;      // corners found in both pictures
  double agreeing_share = 0;        // of them: same row to 2 px and not beyond infinity, after rectification
  double vertical_p50_px = 0;       // |difference of rows|
  double vertical_p95_px = 0;       // of those that agree roughly (to 10 px); mismatches are beyond
  double vertical_bias_px = 0;      // median of right row - left row: a constant one is a shifted picture
  std::vector<std::string> faults;  // in words, with what to do; empty: nothing is wrong
};

/// Matches corners left and right, rectifies them by the calibration, and looks whether rows agree. Where
/// they do not, tries the usual mix-ups (pictures exchanged, cameras exchanged, transform the other way
/// round) and names the one that explains the pictures. Never throws for a bad calibration; that is a fault.
[[nodiscard]] CalibrationReview review_calibration(const StereoCalibration& calibration,
                                                   const std::vector<StereoFrame>& frames);

}  // namespace flogmap
