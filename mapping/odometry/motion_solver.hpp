// Corresponding points in two frames -> the rigid motion between them, how sure it is, and which points fit.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/odometry/consistency.hpp"
#include "mapping/odometry/stereo_pixel.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// A point known in the key frame, and where the current frame sees it.
struct MotionPoint {
  Eigen::Vector3d in_key;      // metres
  Eigen::Matrix3d covariance;  // of in_key, metres^2
  StereoPixel current;
  double view_change = 0;  // of its surface, see Sighting
};

struct MotionOptions {
  double image_sigma_px = 0.15;  // of x and y of an aligned corner
  double disparity_sigma_px = 0.15;
  double view_change_sigma_px = 0.2;  // added to it where a surface is seen quite differently (change 1)
  double robust_sigmas = 1.0;         // a residual of that many standard deviations has half the weight
  double inlier_sigmas = 4.0;         // beyond that many it is an outlier
  int max_iterations = 12;
};

struct Motion {
  SE3 current_from_key = SE3::Identity();
  Covariance6 covariance = Covariance6::Zero();  // perturbation exp(x) * current_from_key
  std::vector<bool> inlier;                      // one per point
  int num_inliers = 0;
  std::optional<SE3> with_decisive;  // if one point outweighed all others together: what it asked for
};

/// Closed form: the rigid motion with the least weighted squared distances (Arun, Huang & Blostein 1987;
/// weights as Haralick et al. 1989). Nothing if the points lie on a line or are fewer than three.
[[nodiscard]] std::optional<SE3> align_points(const std::vector<PointPair>& pairs,
                                              const std::vector<double>& weights);

/// Levenberg-Marquardt from `start` on the stereo pixels of the current frame. The errors of the key frame's
/// pixels enter through the points' covariances, so all four images count, as if every point were estimated
/// along (to first order). Nothing if the points do not determine six degrees of freedom.
///
/// Most errors are a few hundredths of a pixel, a few are many times that (edges of depth, wrong slants), all
/// within the bounds of an inlier: so the loss is Cauchy's, which lets the many decide.
///
/// A point that outweighs all others together in some direction of the motion fits wherever it was found, and
/// nothing would contradict it if it were a wrong one. It is left out and counts as an outlier.
[[nodiscard]] std::optional<Motion> refine_motion(const StereoCamera& camera,
                                                  const std::vector<MotionPoint>& points, const SE3& start,
                                                  const MotionOptions& options);

/// exp of a twist (translation, rotation): rotation by Rodrigues, translation as it stands.
[[nodiscard]] SE3 small_motion(const Eigen::Matrix<double, 6, 1>& x);

}  // namespace flogmap
