#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "camera/board_calibration/stereo_calibrator.hpp"

namespace flogmap {

enum class CalibrationGrade : std::uint8_t {
  good,    // maps as well as these cameras can
  usable,  // maps; what is advised makes it better
  redo,    // would spoil disparities
};

/// How good a calibration is, and what to do about it.
struct CalibrationVerdict {
  CalibrationGrade grade = CalibrationGrade::redo;
  double rms_px = 0;           // distance between corners and where the calibration puts them
  double epipolar_p95_px = 0;  // rectified: rows of the same corner left and right differ by less, for 95 %
  double baseline_m = 0;
  double baseline_sigma_m = 0;
  double field_of_view_rad = 0;  // horizontal, of the rectified pair
  std::size_t num_pairs = 0;
  std::size_t num_corners = 0;
  std::size_t num_left_out = 0;
  std::vector<std::string> advice;  // what to redo, in words; most urgent first
};

/// `names`: one per pair, for messages ("left05.png").
[[nodiscard]] CalibrationVerdict judge(const CalibrationResult& result,
                                       const std::vector<std::string>& names);

/// Vertical distances [px] between both views of every corner seen by both, after rectification; unsorted.
[[nodiscard]] std::vector<double> epipolar_errors_px(const CalibrationResult& result);

[[nodiscard]] const char* grade_name(CalibrationGrade grade);

}  // namespace flogmap
