// Loops in recordings with ground truth: those that are there are found, no other is believed, and the map
// afterwards is the one of the final poses. And what becomes of a covered lens and of swapped pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapping/loop/loop_closer.hpp"
#include "mapping/map_builder.hpp"
#include "recording_run.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/same_cells.hpp"

namespace flogmap {
namespace {

using namespace test;

FrontEndOptions unlevelled() {
  FrontEndOptions options;
  options.first_world_from_camera = SE3::Identity();
  return options;
}

/// The true pose of the frame of this time; by frame number where the truth has no times.
const SE3& true_pose(const Trajectory& truth, const RecordingRun& run, std::int64_t timestamp_ns) {
  const auto nearest = [&](const std::vector<TimedPose>& poses) {
    const auto gap = [&](const TimedPose& pose) { return std::abs(pose.timestamp_ns - timestamp_ns); };
    return std::min_element(poses.begin(), poses.end(),
                            [&](const TimedPose& a, const TimedPose& b) { return gap(a) < gap(b); }) -
           poses.begin();
  };
  return truth.poses.at(nearest(truth.timed ? truth.poses : run.path.poses)).world_from_camera;
}

/// The loops that are closed in a run; each must be what the truth says, to a few centimetres.
int num_true_loops(const RecordingRun& run, const Trajectory& truth) {
  LoopCloser closer({}, run.camera);
  for (const View& view : run.views) (void)closer.add(view);
  int num_loops = 0;
  for (const PoseEdge& edge : closer.edges()) {
    if (!edge.may_be_wrong) continue;
    ++num_loops;
    const SE3 &from = true_pose(truth, run, run.views[edge.from].timestamp_ns),
              &to = true_pose(truth, run, run.views[edge.to].timestamp_ns);
    const double true_m = (from.translation() - to.translation()).norm();
    EXPECT_NEAR(edge.from_to.translation().norm(), true_m, 0.05) << edge.from << " - " << edge.to;
    const double true_rad = Eigen::AngleAxisd((from.inverse() * to).linear()).angle();
    EXPECT_NEAR(Eigen::AngleAxisd(edge.from_to.linear()).angle(), true_rad, 0.03);
  }
  return num_loops;
}

struct Recorded {
  const char *name, *kind, *truth;
};

TEST(RecordedLoops, NoneIsFalse) {
  for (const Recorded& r :
       {Recorded{"euroc_mh01_10hz", "euroc", "groundtruth_cam0.tum"},
        Recorded{"kitti03", "kitti", "poses.txt"}, Recorded{"two-boxes-near", "euroc", "groundtruth.tum"},
        Recorded{"two-boxes-far", "euroc", "groundtruth.tum"}}) {
    const auto folder = recording(r.name);
    if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with " << r.name;
    SCOPED_TRACE(r.name);
    (void)num_true_loops(run_recording(r.kind, *folder, unlevelled()), read_trajectory(*folder / r.truth));
  }
}

TEST(RecordedLoops, HouseClosesItsLoopAndItsMapIsThatOfTheFinalPoses) {
  const auto folder = recording("house-dev");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with house-dev";
  FrontEndOptions options;
  options.align = AlignMode::ground;
  const RecordingRun run = run_recording("euroc", *folder, options);
  EXPECT_GE(num_true_loops(run, read_trajectory(*folder / "groundtruth.tum")), 1);

  LoopOptions loops;
  loops.least_change_m = 0.0005;  // so that there is something to build anew
  LoopCloser closer(loops, run.camera);
  MapBuilder builder(MapIntegrator({}, run.camera, run.max_disparity_px), {});
  PathCorrection last;
  for (View view : run.views) {
    builder.add(view);
    if (auto correction = closer.add(view)) builder.correct(last = std::move(correction->path));
  }
  ASSERT_FALSE(last.knots().empty());
  while (builder.is_behind()) builder.catch_up();

  MapIntegrator from_scratch({}, run.camera, run.max_disparity_px);
  for (View view : run.views) {
    round_disparity(view.disparity);
    view.world_from_camera =
        *last.map_from_odometry(view.timestamp_ns, view.segment) * view.world_from_camera;
    from_scratch.integrate(view);
  }
  EXPECT_FALSE(from_scratch.snapshot().tiles.empty());
  expect_same_cells(builder.map().snapshot(), from_scratch.snapshot());
}

TEST(RecordedLoss, CoveredLensIsNoticedAtOnceAndNothingIsDrawnInAWrongPlace) {
  const auto folder = recording("euroc_mh01_10hz");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with euroc_mh01_10hz";
  constexpr int kFrom = 50, kTo = 70;
  const auto cover = [&](StereoFrame& frame, int number) {
    if (number < kFrom || number >= kTo) return;
    for (Picture* picture : {&frame.left, &frame.right})
      std::fill(picture->bytes.begin(), picture->bytes.end(), std::uint8_t{2});
  };
  const RecordingRun seen = run_recording("euroc", *folder, unlevelled());
  const RecordingRun covered = run_recording("euroc", *folder, unlevelled(), cover);
  for (int i = kFrom + 1; i < kTo; ++i) {
    EXPECT_EQ(covered.trackings[i].state, TrackingState::lost);
    EXPECT_THAT(covered.trackings[i].reason, testing::HasSubstr("dark"));
  }
  for (int i = kTo + 4; i < 110; ++i) EXPECT_TRUE(covered.trackings[i].has_pose()) << i;
  for (const View& view : covered.views) {
    EXPECT_EQ(view.segment, 0);
    const SE3 as_seen = true_pose(seen.path, seen, view.timestamp_ns);
    EXPECT_LE((view.world_from_camera.translation() - as_seen.translation()).norm(), 0.02);
  }
}

TEST(RecordedLoss, SwappedPicturesAreNoticed) {
  for (const char* name : {"euroc_mh01_10hz", "house-dev"}) {
    const auto folder = recording(name);
    if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with " << name;
    const auto source =
        open_source({.spec = "euroc:" + folder->string(), .calibration_file = {}, .loop = false, .seed = 1});
    FrontEnd front_end(unlevelled(), Rectifier(*source->calibration()), std::nullopt, std::nullopt);
    for (int i = 0; i < 5; ++i) {
      auto frame = source->next();
      std::swap(frame->left, frame->right);
      const Tracking tracking = front_end.process(*frame).tracking;
      EXPECT_FALSE(tracking.has_pose()) << name;
      EXPECT_THAT(tracking.reason, testing::HasSubstr("swapped")) << name;
    }
  }
}

}  // namespace
}  // namespace flogmap
