#pragma once

namespace flogmap {

/// The rectified pinhole pair: both cameras share focal length and centre, their x axes lie on the baseline.
/// Camera axes: x right, y down, z forward. Disparity d = x_l - x_r >= 0.
struct StereoCamera {
  double focal_px = 0;  // f of the paper
  double cx_px = 0;     // principal point, same in both images
  double cy_px = 0;
  double baseline_m = 0;  // t of the paper
  int width_px = 0;
  int height_px = 0;

  bool operator==(const StereoCamera&) const = default;
};

}  // namespace flogmap
