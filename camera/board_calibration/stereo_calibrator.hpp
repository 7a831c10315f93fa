#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "camera/board_calibration/board.hpp"
#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// What a pair of pictures shows of the board; either side may be empty, and each may show other points.
struct BoardPair {
  BoardView left, right;
};

/// One observed point: which, where, and how far the calibration is off.
struct CornerError {
  std::size_t pair = 0;
  bool right = false;
  int point = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d error_px = Eigen::Vector2d::Zero();  // predicted - observed
  bool used = true;  // false: too far off to be a corner of the board; left out
};

struct CalibrationResult {
  StereoCalibration calibration;
  std::vector<Eigen::Isometry3d> left_from_board;  // one per pair
  std::vector<CornerError> corners;
  double rms_px = 0;       // of the corners used: root mean square distance
  double focal_sigma = 0;  // standard deviation of the left focal length / that length
  double baseline_sigma_m = 0;
};

struct CalibratorOptions {
  Distortion model = Distortion::radtan;  // radtan, rational or equidistant
  int width_px = 0;
  int height_px = 0;
  std::function<void(double share)> on_progress{};  // 0 to 1
};

/// Both cameras' lenses, how they stand to one another, and where the board was held, all at once: the values
/// for which the board's points, seen through the cameras, fall nearest to the pixels found (least squares,
/// Levenberg-Marquardt; far-off corners weigh less and are left out at the end). Tried from several focal
/// lengths, so it needs no guess. Throws std::runtime_error if there are too few views.
[[nodiscard]] CalibrationResult calibrate_stereo(const std::vector<Eigen::Vector3d>& board,
                                                 const std::vector<BoardPair>& pairs,
                                                 const CalibratorOptions& options);

}  // namespace flogmap
