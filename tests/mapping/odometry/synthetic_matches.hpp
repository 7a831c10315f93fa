// Correspondences of a known motion, with noise and with wrong ones among them. Seeded.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "mapping/odometry/consistency.hpp"
#include "mapping/odometry/motion_solver.hpp"
#include "mapping/odometry/stereo_pixel.hpp"

namespace flogmap::test {

inline constexpr StereoCamera kMatchCamera{435, 375.5, 239.5, 0.11, 752, 480};

/// A point somewhere in the picture, between near and far.
inline Eigen::Vector3d random_point(std::mt19937& random, double near_m, double far_m) {
  std::uniform_real_distribution<double> x(20, 730), y(20, 460), z(near_m, far_m);
  const double d = kMatchCamera.focal_px * kMatchCamera.baseline_m / z(random);
  return triangulate(kMatchCamera, StereoPixel(x(random), y(random), d));
}

inline SE3 random_motion(std::mt19937& random, double metres, double radians) {
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  SE3 motion = SE3::Identity();
  motion.linear() = Eigen::AngleAxisd(radians, direction()).toRotationMatrix();
  motion.translation() = metres * direction();
  return motion;
}

/// The point as a camera with independent pixel errors triangulates it.
inline Eigen::Vector3d measured(std::mt19937& random, const Eigen::Vector3d& p, double sigma_px) {
  std::normal_distribution<double> noise(0, sigma_px);
  const StereoPixel s = project(kMatchCamera, p) + StereoPixel(noise(random), noise(random), noise(random));
  return triangulate(kMatchCamera, s);
}

struct SyntheticMatches {
  SE3 current_from_key;
  std::vector<PointPair> pairs;
  std::vector<bool> right;  // one per pair: a true correspondence
};

/// `num_right` true correspondences of one motion, shuffled among `num_wrong` that belong to none.
inline SyntheticMatches synthetic_matches(std::mt19937& random, const SE3& current_from_key, int num_right,
                                          int num_wrong, double sigma_px) {
  SyntheticMatches matches{current_from_key, {}, {}};
  matches.right.assign(num_right + num_wrong, false);
  std::fill_n(matches.right.begin(), num_right, true);
  std::shuffle(matches.right.begin(), matches.right.end(), random);
  for (const bool right : matches.right) {
    const Eigen::Vector3d p = random_point(random, 1, 6);
    const Eigen::Vector3d q = right ? Eigen::Vector3d(current_from_key * p) : random_point(random, 1, 6);
    matches.pairs.push_back({measured(random, p, sigma_px), measured(random, q, sigma_px)});
  }
  return matches;
}

}  // namespace flogmap::test
