// The whole vision chain on real and rendered recordings with ground truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

Outcome run(const std::filesystem::path& folder, const FrontEndOptions& options) {
  const auto source =
      open_source({.spec = "euroc:" + folder.string(), .calibration_file = {}, .loop = false, .seed = 1});
  FrontEnd front_end(options, Rectifier(*source->calibration()), std::nullopt, std::nullopt);
  Outcome outcome;
  const auto take = [&](const FrontEndResult& result) {
    for (const TrajectoryEntry& entry : result.path) {
      outcome.path.poses.push_back({entry.timestamp_ns, entry.world_from_camera});
    }
  };
  while (const auto frame = source->next()) {
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

TEST(Recordings, MachineHallIsTrackedThroughoutAndTrueToThreeCentimetres) {
  const auto folder = recording("euroc_mh01_10hz");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with euroc_mh01_10hz";
  const Outcome outcome = run(*folder, {});
  EXPECT_EQ(outcome.frames, 110);
  EXPECT_EQ(outcome.tracked, outcome.frames);
  ASSERT_EQ(outcome.path.poses.size(), static_cast<std::size_t>(outcome.frames));
  const auto error = evaluate_trajectory(outcome.path, read_trajectory(*folder / "groundtruth_cam0.tum"));
  EXPECT_LE(error.ate_rmse_m, 0.03);
}

TEST(Recordings, HouseIsLevelledByItsFloorToOneDegreeAndThreeCentimetres) {
  const auto folder = recording("house-dev");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with house-dev";
  FrontEndOptions options;
  options.align = AlignMode::ground;
  const Outcome outcome = run(*folder, options);
  EXPECT_EQ(outcome.tracked, outcome.frames);
  const auto error = evaluate_trajectory(outcome.path, read_trajectory(*folder / "groundtruth.tum"));
  EXPECT_LE(error.ate_rmse_m, 0.024);  // what corners, LK and PnP score
  EXPECT_LE(tilt_deg(error.truth_from_estimate), 1.0);
  EXPECT_LE(std::abs(error.truth_from_estimate.translation().z()), 0.03);
}

}  // namespace
}  // namespace flogmap
