#include "mapping/odometry/stereo_pixel.hpp"

#include <gtest/gtest.h>

#include <random>

namespace flogmap {
namespace {

constexpr StereoCamera kCamera{435, 370, 250, 0.11, 752, 480};

std::vector<StereoPixel> random_pixels(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(0, 751), y(0, 479), d(0.5, 90);
  std::vector<StereoPixel> pixels;
  for (int i = 0; i < count; ++i) pixels.emplace_back(x(random), y(random), d(random));
  return pixels;
}

TEST(StereoPixel, ProjectUndoesTriangulate) {
  for (const StereoPixel& s : random_pixels(1000)) {
    EXPECT_LT((project(kCamera, triangulate(kCamera, s)) - s).norm(), 1e-9);
  }
}

TEST(StereoPixel, JacobiansAreDerivativesAndInverses) {
  for (const StereoPixel& s : random_pixels(200)) {
    const Eigen::Vector3d p = triangulate(kCamera, s);
    const Eigen::Matrix3d J_p = project_jacobian(kCamera, p), J_s = triangulate_jacobian(kCamera, s);
    EXPECT_LT((J_p * J_s - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d h = 1e-6 * p.z() * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d numeric = (project(kCamera, p + h) - project(kCamera, p - h)) / (2e-6 * p.z());
      EXPECT_LT((numeric - J_p.col(axis)).norm(), 1e-5 * J_p.norm());
    }
  }
}

}  // namespace
}  // namespace flogmap
