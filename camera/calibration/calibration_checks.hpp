#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap {

/// The nearest rotation to a row-major 3x3 list; throws std::runtime_error starting with `where` if that is
/// further away than rounding explains.
[[nodiscard]] Eigen::Matrix3d checked_rotation(const std::vector<double>& row_major,
                                               const std::string& where);

/// Sets model and coefficients by the name a dialect uses ("radial-tangential", "radtan", "plumb_bob",
/// "rational_polynomial", "equidistant", "fisheye", "none", ...). Throws naming what is allowed.
void set_distortion(CameraIntrinsics& camera, const std::string& model, std::vector<double> coefficients,
                    const std::string& where);

/// Sets a resolution; throws unless it is two whole numbers in [16, 32768].
void set_resolution(CameraIntrinsics& camera, const std::vector<double>& width_height,
                    const std::string& where);

/// Sets focal lengths and centre [px]; throws unless the focal lengths are > 0.
void set_pinhole(CameraIntrinsics& camera, double fx, double fy, double cx, double cy,
                 const std::string& where);

/// Throws if the cameras stand more than 10 m apart: units that are off by a thousand are the commonest
/// mistake of all.
void check_baseline(const StereoCalibration& calibration);

/// Gives a calibration that knows no resolution (0) that of the pictures; throws std::runtime_error starting
/// with `where` if it is for another one.
void fit_resolution(StereoCalibration& calibration, int width_px, int height_px, const std::string& where);

}  // namespace flogmap
