#include "mapping/loop/pose_graph.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <numbers>
#include <random>

#include "mapping/odometry/motion_solver.hpp"

namespace flogmap {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Poses around a circle of 2 m, looking along it, the last one back at the first.
std::vector<SE3> circle(int count) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / (count - 1);
    SE3 pose = SE3::Identity();
    pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() =
        Eigen::Vector3d(2 * std::sin(angle), 2 - 2 * std::cos(angle), 0.1 * std::sin(3 * angle));
    poses.push_back(pose);
  }
  return poses;
}

Covariance6 covariance_of(double sigma_m, double sigma_rad) {
  Vector6 sigma;
  sigma << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
  return sigma.cwiseAbs2().asDiagonal();
}

Vector6 random_twist(std::mt19937& random, double sigma_m, double sigma_rad) {
  std::normal_distribution<double> normal;
  Vector6 x;
  for (int i = 0; i < 6; ++i) x(i) = (i < 3 ? sigma_m : sigma_rad) * normal(random);
  return x;
}

/// Edges from each pose to the next, with noise.
std::vector<PoseEdge> noisy_steps(const std::vector<SE3>& truth, std::mt19937& random, double sigma_m,
                                  double sigma_rad) {
  std::vector<PoseEdge> edges;
  for (int i = 1; i < static_cast<int>(truth.size()); ++i) {
    const SE3 step = truth[i - 1].inverse() * truth[i];
    edges.push_back({i - 1, i, small_motion(random_twist(random, sigma_m, sigma_rad)) * step,
                     covariance_of(sigma_m, sigma_rad), false});
  }
  return edges;
}

std::vector<SE3> chained(const std::vector<PoseEdge>& steps) {
  std::vector<SE3> poses{SE3::Identity()};
  for (const PoseEdge& e : steps) poses.push_back(poses.back() * e.from_to);
  return poses;
}

double rms_gap(const std::vector<SE3>& a, const std::vector<SE3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i].translation() - b[i].translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(PoseGraph, WithoutLoopsStaysWithOdometry) {
  std::mt19937 random(1);
  const auto steps = noisy_steps(circle(40), random, 0.01, 0.01);
  const auto start = chained(steps);
  const auto poses = optimise_poses(start, steps, {});
  EXPECT_LT(rms_gap(poses, start), 1e-9);
}

TEST(PoseGraph, ExactEdgesAreMetFromABadStart) {
  std::mt19937 random(2);
  const auto truth = circle(30);
  auto edges = noisy_steps(truth, random, 0, 0);
  for (PoseEdge& e : edges) e.covariance = covariance_of(0.01, 0.01);
  edges.push_back({0, 29, truth[0].inverse() * truth[29], covariance_of(0.01, 0.01), true});
  auto start = truth;
  for (std::size_t i = 1; i < start.size(); ++i)
    start[i] = start[i] * small_motion(random_twist(random, 0.2, 0.2));
  EXPECT_LT(rms_gap(optimise_poses(start, edges, {}), truth), 1e-6);
}

TEST(PoseGraph, OneLoopTakesMostOfTheDriftAway) {
  std::mt19937 random(3);
  const auto truth = circle(60);
  double before = 0, after = 0;
  for (int trial = 0; trial < 20; ++trial) {
    auto edges = noisy_steps(truth, random, 0.01, 0.01);
    const auto start = chained(edges);
    edges.push_back({0, 59, truth[0].inverse() * truth[59], covariance_of(0.002, 0.001), true});
    before += rms_gap(start, truth);
    after += rms_gap(optimise_poses(start, edges, {}), truth);
  }
  EXPECT_LT(after, 0.6 * before);
}

TEST(PoseGraph, FalseLoopLosesItsPull) {
  std::mt19937 random(4);
  const auto truth = circle(60);
  auto edges = noisy_steps(truth, random, 0.002, 0.001);
  const auto start = chained(edges);
  SE3 wrong = SE3::Identity();
  wrong.translation() = Eigen::Vector3d(3, -2, 0);
  edges.push_back({10, 40, wrong, covariance_of(0.005, 0.003), true});
  EXPECT_LT(rms_gap(optimise_poses(start, edges, {}), start), 0.05);
}

TEST(PoseGraph, FirstPoseStaysAndSinglePosesPass) {
  std::mt19937 random(5);
  auto edges = noisy_steps(circle(10), random, 0.01, 0.01);
  const auto start = chained(edges);
  EXPECT_EQ(optimise_poses(start, edges, {})[0].matrix(), start[0].matrix());
  EXPECT_EQ(optimise_poses({start[3]}, {}, {})[0].matrix(), start[3].matrix());
}

}  // namespace
}  // namespace flogmap
