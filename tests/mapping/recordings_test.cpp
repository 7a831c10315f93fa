// The whole vision chain on real and rendered recordings with ground truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "camera/source_spec.hpp"
#include "mapping/front_end.hpp"
#include "mapping/odometry/trajectory_error.hpp"
#include "tests/support/recordings.hpp"

namespace flogmap {
namespace {

/// What the chain makes of a recording.
struct Outcome {
  int frames = 0;
  int tracked = 0;
  Trajectory path;
};

/// Takes every `every`-th frame only.
Outcome run(const std::filesystem::path& folder, const FrontEndOptions& options, int every = 1) {
  const auto source =
      open_source({.spec = "euroc:" + folder.string(), .calibration_file = {}, .loop = false, .seed = 1});
  Rectifier rectifier(*source->calibration());
  std::optional<Eigen::Vector3d> up = source->up_in_left_camera();
  if (up) up = rectifier.rectified_from_raw_left().linear() * *up;
  FrontEnd front_end(options, std::move(rectifier), std::nullopt, up);
  Outcome outcome;
  const auto take = [&](const FrontEndResult& result) {
    for (const TrajectoryEntry& entry : result.path) {
      outcome.path.poses.push_back({entry.timestamp_ns, entry.world_from_camera});
    }
  };
  int number = 0;
  while (const auto frame = source->next()) {
    if (number++ % every != 0) continue;
    const FrontEndResult result = front_end.process(*frame);
    ++outcome.frames;
    outcome.tracked += result.tracking.has_pose() ? 1 : 0;
    take(result);
  }
  take(front_end.finish());
  return outcome;
}

double tilt_deg(const SE3& truth_from_estimate) {
  return std::acos(std::min(1.0, truth_from_estimate.linear()(2, 2))) * 180 / std::numbers::pi;
}

TEST(Recordings, MachineHallIsTrackedThroughoutAlsoByEveryFourthFrame) {
  const auto folder = recording("euroc_mh01_10hz");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with euroc_mh01_10hz";
  const Trajectory truth = read_trajectory(*folder / "groundtruth_cam0.tum");
  const Outcome all = run(*folder, {}), few = run(*folder, {}, 4);
  EXPECT_EQ(all.frames, 110);
  EXPECT_EQ(few.frames, 28);
  EXPECT_EQ(all.tracked, all.frames);
  EXPECT_EQ(few.tracked, few.frames);
  ASSERT_EQ(all.path.poses.size(), static_cast<std::size_t>(all.frames));
  const double ate_m = evaluate_trajectory(all.path, truth).ate_rmse_m;
  EXPECT_LE(ate_m, 0.0042);  // what others score on the whole recording
  EXPECT_LE(evaluate_trajectory(few.path, truth).ate_rmse_m, 2 * ate_m);
}

TEST(Recordings, HouseIsLevelledByItsFloorToOneDegreeAndThreeCentimetres) {
  const auto folder = recording("house-dev");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with house-dev";
  FrontEndOptions options;
  options.align = AlignMode::ground;
  const Outcome outcome = run(*folder, options);
  EXPECT_EQ(outcome.tracked, outcome.frames);
  const auto error = evaluate_trajectory(outcome.path, read_trajectory(*folder / "groundtruth.tum"));
  EXPECT_LE(error.ate_rmse_m, 0.012);
  EXPECT_LE(error.end_error_m, 0.05);
  EXPECT_LE(tilt_deg(error.truth_from_estimate), 1.0);
  EXPECT_LE(std::abs(error.truth_from_estimate.translation().z()), 0.03);
}

TEST(Recordings, HouseIsTrackedThroughoutByEveryThirdFrame) {
  const auto folder = recording("house-dev");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with house-dev";
  const Outcome outcome = run(*folder, {}, 3);
  EXPECT_EQ(outcome.frames, 107);
  EXPECT_EQ(outcome.tracked, outcome.frames);
  const auto error = evaluate_trajectory(outcome.path, read_trajectory(*folder / "groundtruth.tum"));
  EXPECT_LE(error.ate_rmse_m, 0.012);
}

/// How far positions are from their mean.
double spread_m(const Trajectory& path) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const TimedPose& pose : path.poses) mean += pose.world_from_camera.translation();
  mean /= static_cast<double>(path.poses.size());
  double squares = 0;
  for (const TimedPose& pose : path.poses)
    squares += (pose.world_from_camera.translation() - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(path.poses.size()));
}

TEST(Recordings, StandingStillIsStandingStillAndLevelByGravityAndByTheFloor) {
  const auto folder = recording("euroc_v101_still");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with euroc_v101_still";
  const Trajectory truth = read_trajectory(*folder / "groundtruth_cam0.tum");
  const SE3 true_pose = truth.poses.front().world_from_camera;  // raw left camera, floor at z = 0
  std::vector<SE3> poses;
  for (const AlignMode align : {AlignMode::gravity, AlignMode::ground}) {
    FrontEndOptions options;
    options.align = align;
    const Outcome outcome = run(*folder, options);
    EXPECT_EQ(outcome.tracked, 30);
    ASSERT_FALSE(outcome.path.poses.empty());
    EXPECT_LE(evaluate_trajectory(outcome.path, truth).ate_rmse_m, 0.0008);
    EXPECT_LE(spread_m(outcome.path), 0.0002);
    poses.push_back(outcome.path.poses.front().world_from_camera);
    EXPECT_NEAR(poses.back().translation().z(), true_pose.translation().z(), 0.03);
  }
  const auto up_in_camera = [](const SE3& pose) -> Eigen::Vector3d { return pose.linear().row(2); };
  EXPECT_GE(up_in_camera(poses[0]).dot(up_in_camera(poses[1])), std::cos(std::numbers::pi / 180));
}

/// A recording as the odometry takes it in.
struct Rectified {
  StereoCamera camera;
  SE3 rectified_from_raw = SE3::Identity();  // left cameras
  std::vector<std::pair<RectifiedFrame, DisparityImage>> frames;
};

Rectified rectified(const std::filesystem::path& folder) {
  const auto source =
      open_source({.spec = "euroc:" + folder.string(), .calibration_file = {}, .loop = false, .seed = 1});
  const Rectifier rectifier(*source->calibration());
  const auto matcher = make_matcher({}, rectifier.camera());
  Rectified all{rectifier.camera(), rectifier.rectified_from_raw_left(), {}};
  while (const auto frame = source->next()) {
    RectifiedFrame pair = rectifier.rectify(*frame);
    DisparityImage disparity = matcher->match(pair);
    all.frames.emplace_back(std::move(pair), std::move(disparity));
  }
  return all;
}

/// How many standard deviations a frame's position is off the one before it, at most. Frames first, first +
/// step, ... are seen in this order.
double most_sigmas(const Rectified& seen, const Trajectory& truth, int first, int step) {
  StereoOdometry odometry({}, seen.camera);
  const int num_frames = static_cast<int>(seen.frames.size());
  std::optional<SE3> odometry_from_world;  // by the frame before
  double most = 0;
  for (int i = first; i >= 0 && i < num_frames; i += step) {
    const Tracking tracking = odometry.track(seen.frames[i].first, seen.frames[i].second);
    if (!tracking.has_pose()) continue;
    const SE3 world_from_camera = truth.poses[i].world_from_camera * seen.rectified_from_raw.inverse();
    if (odometry_from_world) {
      const SE3 error = (*odometry_from_world * world_from_camera).inverse() * tracking.odometry_from_camera;
      const double sigma_m = std::sqrt(tracking.covariance.diagonal().head<3>().sum());
      most = std::max(most, error.translation().norm() / sigma_m);
    }
    odometry_from_world = tracking.odometry_from_camera * world_from_camera.inverse();
  }
  return most;
}

TEST(Recordings, NoPoseOfABareRoomHangsOnOneWrongLandmark) {
  const auto folder = recording("two-boxes-far");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with two-boxes-far";
  const Trajectory truth = read_trajectory(*folder / "groundtruth.tum");
  const Rectified frames = rectified(*folder);
  ASSERT_EQ(frames.frames.size(), truth.poses.size());
  for (const auto& [first, step] : {std::pair{7, 1}, {25, -1}, {7, 2}, {25, -2}}) {
    EXPECT_LT(most_sigmas(frames, truth, first, step), 5) << first << " by " << step;
  }
}

TEST(Recordings, StandingStillForLongDoesNotDrift) {
  const auto folder = recording("euroc_v101_still");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with euroc_v101_still";
  const Rectified still = rectified(*folder);
  const auto& frames = still.frames;
  StereoOdometry odometry({}, still.camera);
  std::vector<SE3> first_round, last_round;
  const char* repeats = std::getenv("FLOGMAP_STILL_FRAMES");  // the whole bar: 10000
  const int num_frames = repeats != nullptr ? std::atoi(repeats) : 600;
  for (int i = 0; i < num_frames; ++i) {
    const auto& [frame, disparity] = frames[i % frames.size()];
    const Tracking tracking = odometry.track(frame, disparity);
    ASSERT_TRUE(tracking.has_pose());
    if (i < 30) first_round.push_back(tracking.odometry_from_camera);
    if (i >= num_frames - 30) last_round.push_back(tracking.odometry_from_camera);
  }
  for (const SE3& pose : last_round) {
    EXPECT_LE((pose.translation() - first_round.front().translation()).norm(), 0.001);
  }
}

}  // namespace
}  // namespace flogmap
