#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace flogmap {

/// How a lens bends rays. Coefficients in the order of the usual tools.
enum class Distortion {
  none,         // already undistorted
  radtan,       // k1 k2 p1 p2 [k3]               (plumb bob)
  rational,     // k1 k2 p1 p2 k3 k4 k5 k6
  equidistant,  // k1 k2 k3 k4                    (fisheye)
};

/// One camera: pinhole intrinsics and distortion, pixels.
struct CameraIntrinsics {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  Distortion distortion = Distortion::none;
  std::vector<double> coefficients;
};

/// Two cameras and how they stand to one another, as any of the five dialects says it.
struct StereoCalibration {
  CameraIntrinsics left;
  CameraIntrinsics right;
  Eigen::Isometry3d right_from_left = Eigen::Isometry3d::Identity();  // metres
  Eigen::Isometry3d body_from_left = Eigen::Isometry3d::Identity();   // T_BS of cam0; identity if unknown
  bool rectified = false;  // pictures are rectified already: only cut to one camera, never warped
  std::string dialect;     // "euroc", "kalibr", "opencv", "ros", "kitti", "simulated"
  std::string origin;      // the file or folder it was read from, for messages
};

}  // namespace flogmap
