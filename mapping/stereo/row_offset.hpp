// Are the rows of a pair really the same in both pictures? Dense matching takes that for granted.
#pragma once

#include <optional>
#include <string>

#include "camera/stereo_frame.hpp"

namespace flogmap {

/// Rows that differ by more than this cost the matcher answers: the calibration does not fit the cameras any
/// more.
inline constexpr double kTolerableRowOffset_px = 0.75;

struct RowOffset {
  double median_px = 0;  // row in the right picture - row in the left one; up to 5 px either way are found
  int num_matches = 0;   // corners it rests on
};

/// Looks for corners of the left picture in the right one, some rows up and down as well. Disparities are
/// looked for in [min_disparity, min_disparity + num_disparities). Nothing if too few corners are found or
/// they disagree, as on a bare wall.
std::optional<RowOffset> measure_row_offset(const RectifiedFrame& pair, int min_disparity,
                                            int num_disparities);

/// What a user should know of an offset; empty where it is tolerable or not known.
std::string words_of_row_offset(std::optional<double> offset_px);

/// Measures a pair now and then, since it costs milliseconds.
class RowWatch {
 public:
  RowWatch(int min_disparity, int num_disparities)
      : min_disparity_(min_disparity), num_disparities_(num_disparities) {}

  /// Median of the last measured pairs, px; nothing before the third. One thread calls it.
  std::optional<double> add(const RectifiedFrame& pair);
  void reset();

 private:
  int min_disparity_, num_disparities_;
  int frame_ = 0, num_measured_ = 0;
  double last_px_[3] = {};
};

}  // namespace flogmap
