#include "mapping/odometry/trajectory_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

namespace flogmap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TrajectoryFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    const auto path = std::filesystem::path(testing::TempDir()) / ("trajectory_" + name);
    std::ofstream(path) << text;
    return path;
  }

  std::string complaint(const std::string& text) {
    try {
      (void)read_trajectory(write(text));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  }
};

TEST_F(TrajectoryFile, TumIsReadWithNanosecondsExact) {
  const auto t =
      read_trajectory(write("# comment\n1403636584.763555584 1 2 3 0 0 0 1\n1403636584.8 4 5 6 1 0 0 0\n"));
  ASSERT_EQ(t.poses.size(), 2U);
  EXPECT_EQ(t.poses[0].timestamp_ns, 1403636584763555584);
  EXPECT_EQ(t.poses[1].timestamp_ns, 1403636584800000000);
  EXPECT_EQ(t.poses[0].world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(t.poses[1].world_from_camera.linear().isApprox(
      Eigen::Vector3d(1, -1, -1).asDiagonal().toDenseMatrix()));
  EXPECT_TRUE(t.timed);
}

TEST_F(TrajectoryFile, EurocHasTheRealPartFirst) {
  const auto t = read_trajectory(write("#timestamp, p...\n1403636584763555584,1,2,3,1,0,0,0,9,9,9\n"));
  ASSERT_EQ(t.poses.size(), 1U);
  EXPECT_EQ(t.poses[0].timestamp_ns, 1403636584763555584);
  EXPECT_TRUE(t.poses[0].world_from_camera.linear().isIdentity());
}

TEST_F(TrajectoryFile, KittiIsNumbered) {
  const auto t = read_trajectory(write("1 0 0 5 0 1 0 6 0 0 1 7\n1 0 0 8 0 1 0 9 0 0 1 10\n"));
  ASSERT_EQ(t.poses.size(), 2U);
  EXPECT_FALSE(t.timed);
  EXPECT_EQ(t.poses[1].world_from_camera.translation(), Eigen::Vector3d(8, 9, 10));
}

/// `from` to `to` - 1 of a walk along a curve, every pose one KITTI line.
std::string kitti_walk(int from, int to) {
  std::string text;
  for (int i = from; i < to; ++i)
    text += "1 0 0 " + std::to_string(0.1 * i * i) + " 0 1 0 " + std::to_string(i) + " 0 0 1 0\n";
  return text;
}

/// The same walk by time, without what is lost.
Trajectory timed_walk(int from, int to, int lost) {
  Trajectory walk;
  for (int i = from; i < to; ++i) {
    SE3 pose = SE3::Identity();
    pose.translation() = Eigen::Vector3d(0.1 * i * i, i, 0);
    if (i != lost) walk.poses.push_back({std::int64_t{100'000'000} * i, pose});
  }
  return walk;
}

TEST_F(TrajectoryFile, KittiTruthIsPairedByTheTimesOfItsSequence) {
  const auto root = std::filesystem::path(testing::TempDir()) / "trajectory_kitti";
  std::filesystem::create_directories(root / "poses");
  std::filesystem::create_directories(root / "sequences" / "07");
  const auto poses = root / "poses" / "07.txt", times = root / "sequences" / "07" / "times.txt";
  std::ofstream(poses) << kitti_walk(0, 8);
  std::filesystem::remove(times);
  EXPECT_FALSE(read_true_trajectory(poses).timed);
  EXPECT_THROW((void)evaluate_trajectory(timed_walk(0, 8, 2), read_true_trajectory(poses)),
               std::runtime_error);
  std::ofstream(times) << "0\n1.000000e-01\n0.2\n0.3\n0.4\n0.5\n0.6\n0.7\n";
  const TrajectoryError error = evaluate_trajectory(timed_walk(0, 8, 2), read_true_trajectory(poses));
  EXPECT_EQ(error.num_poses, 7);
  EXPECT_NEAR(error.ate_rmse_m, 0, 1e-9);
  std::ofstream(times) << "0\n0.1\n";
  EXPECT_THROW((void)read_true_trajectory(poses), std::runtime_error);
}

TEST_F(TrajectoryFile, ErrorsNameFileLineAndWhatIsAllowed) {
  EXPECT_THAT(complaint("1 2 3\n"),
              AllOf(HasSubstr("trajectory_ErrorsName"), HasSubstr(":1: has 3 numbers"), HasSubstr("KITTI")));
  EXPECT_THAT(complaint("1 1 2 3 0 0 0 1\n2 1 2 3 0 0 x 1\n"), HasSubstr(":2: 'x' is not a number"));
  EXPECT_THAT(complaint("1 1 2 3 0 0 0 1\n2 1 2 3 0 0\n"), HasSubstr(":2: has 6 of 8 numbers"));
  EXPECT_THAT(complaint("1 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n"), HasSubstr(":2: times must increase"));
  EXPECT_THAT(complaint("1 1 2 3 0 0 0 2\n"), HasSubstr(":1: the quaternion's length must be 1"));
  EXPECT_THAT(complaint("1 0 0 5 0 2 0 6 0 0 1 7\n"),
              HasSubstr(":1: the first 3 x 3 numbers must be a rotation"));
  EXPECT_THAT(complaint("# nothing\n"), HasSubstr("holds no pose"));
  EXPECT_THROW((void)read_trajectory("/nowhere/t.tum"), std::runtime_error);
}

SE3 random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  SE3 pose = SE3::Identity();
  pose.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(normal(random), normal(random), normal(random));
  return pose;
}

/// A walk along a curve, one pose every 0.1 s.
Trajectory walk(int count) {
  Trajectory t;
  for (int i = 0; i < count; ++i) {
    SE3 pose = SE3::Identity();
    pose.linear() = Eigen::AngleAxisd(0.02 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(0.1 * i, std::sin(0.1 * i), 0.2 * std::cos(0.07 * i));
    t.poses.push_back({i * std::int64_t{100'000'000}, pose});
  }
  return t;
}

TEST(TrajectoryError, IsZeroWhateverFrameTheEstimateIsIn) {
  std::mt19937 random(5);
  const Trajectory truth = walk(100);
  Trajectory moved = truth;
  const SE3 other_from_world = random_pose(random);
  for (TimedPose& pose : moved.poses) pose.world_from_camera = other_from_world * pose.world_from_camera;
  const TrajectoryError e = evaluate_trajectory(moved, truth);
  EXPECT_EQ(e.num_poses, 100);
  EXPECT_NEAR(e.ate_rmse_m + e.rpe_rmse_m + e.drift_percent + e.end_error_m, 0, 1e-9);
  EXPECT_NEAR(e.rpe_rmse_deg + e.drift_deg_per_m + e.end_error_deg, 0, 1e-4);
  EXPECT_TRUE(e.truth_from_estimate.isApprox(other_from_world.inverse(), 1e-9));
}

TEST(TrajectoryError, ScaleErrorOfOnePercentIsDriftOfOnePercent) {
  const Trajectory truth = walk(200);
  Trajectory estimate = truth;
  for (TimedPose& pose : estimate.poses) pose.world_from_camera.translation() *= 1.01;
  const TrajectoryError e = evaluate_trajectory(estimate, truth);
  EXPECT_NEAR(e.drift_percent, 1, 0.25) << "pieces are cut at whole poses and measured along the curve";
  EXPECT_GT(e.ate_rmse_m, 0.01) << "no scale is taken out";
}

TEST(TrajectoryError, AlternatingErrorIsTheAte) {
  const Trajectory truth = walk(100);
  Trajectory estimate = truth;
  for (std::size_t i = 0; i < estimate.poses.size(); ++i) {
    estimate.poses[i].world_from_camera.translation().z() += i % 2 == 0 ? 0.01 : -0.01;
  }
  EXPECT_NEAR(evaluate_trajectory(estimate, truth).ate_rmse_m, 0.01, 1e-4);
}

TEST(TrajectoryError, ComparesByTimeAndCountsPartners) {
  const Trajectory truth = walk(100);
  Trajectory estimate;
  for (std::size_t i = 3; i < 100; i += 4) {
    TimedPose pose = truth.poses[i];
    pose.timestamp_ns += i % 8 == 3 ? 9'000'000 : 11'000'000;  // just near enough, just too far
    estimate.poses.push_back(pose);
  }
  EXPECT_EQ(evaluate_trajectory(estimate, truth).num_poses, 13);
  estimate.poses.resize(2);
  EXPECT_THROW((void)evaluate_trajectory(estimate, truth), std::runtime_error);
}

}  // namespace
}  // namespace flogmap
