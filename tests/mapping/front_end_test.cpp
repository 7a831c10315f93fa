#include "mapping/front_end.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "camera/source_spec.hpp"

namespace flogmap {
namespace {

constexpr int kFrames = 12;

/// The first frames of the simulated room and where the camera truly was.
struct Room {
  std::vector<StereoFrame> frames;
  std::vector<SE3> true_poses;
  StereoCalibration calibration;
  std::optional<Eigen::Vector3d> up;

  Room() {
    const auto source = open_source({.spec = "sim:room", .calibration_file = {}, .loop = false, .seed = 1});
    calibration = *source->calibration();
    up = source->up_in_left_camera();
    for (int i = 0; i < kFrames; ++i) {
      frames.push_back(*source->next());
      true_poses.push_back(*source->true_pose(frames.back().timestamp_ns));
    }
  }
};

const Room& room() {
  static const Room the_room;
  return the_room;
}

FrontEnd make_front_end(const FrontEndOptions& options, bool with_gravity = false) {
  return {options, Rectifier(room().calibration), std::nullopt,
          with_gravity ? room().up : std::optional<Eigen::Vector3d>()};
}

TEST(FrontEnd, WithTheTrueFirstPoseEveryFrameLandsWhereItTrulyWas) {
  FrontEndOptions options;
  options.first_world_from_camera = room().true_poses.front();
  FrontEnd front_end = make_front_end(options);
  for (int i = 0; i < kFrames; ++i) {
    const FrontEndResult result = front_end.process(room().frames[static_cast<std::size_t>(i)]);
    ASSERT_TRUE(result.world_from_camera) << "frame " << i << ": " << result.tracking.reason;
    const SE3 error = room().true_poses[static_cast<std::size_t>(i)].inverse() * *result.world_from_camera;
    EXPECT_LT(error.translation().norm(), 0.01) << "frame " << i;
    ASSERT_EQ(result.path.size(), 1U);
    EXPECT_EQ(result.path[0].timestamp_ns, room().frames[static_cast<std::size_t>(i)].timestamp_ns);
  }
}

TEST(FrontEnd, TheFirstTrackedFrameIsAView) {
  FrontEndOptions options;
  options.first_world_from_camera = SE3::Identity();
  FrontEnd front_end = make_front_end(options);
  EXPECT_EQ(front_end.process(room().frames[0]).views.size(), 1U);
  EXPECT_TRUE(front_end.process(room().frames[0]).views.empty()) << "a camera that stands still adds no view";
}

TEST(FrontEnd, NoFrameIsLostWhileItIsUndecidedWhichWayIsUp) {
  FrontEndOptions options;
  options.level.max_wait_s = 1e6;          // never decided by time ...
  options.level.enough_patches = 1 << 30;  // ... nor by what is seen
  FrontEnd front_end = make_front_end(options);
  for (const StereoFrame& frame : room().frames) {
    const FrontEndResult result = front_end.process(frame);
    EXPECT_FALSE(result.world_from_camera);
    EXPECT_TRUE(result.path.empty());
  }
  const FrontEndResult rest = front_end.finish();
  ASSERT_EQ(rest.path.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < rest.path.size(); ++i) {
    EXPECT_EQ(rest.path[i].timestamp_ns, room().frames[i].timestamp_ns);
  }
  const auto mapped =
      std::count_if(rest.path.begin(), rest.path.end(), [](const auto& entry) { return entry.mapped; });
  EXPECT_EQ(rest.views.size(), static_cast<std::size_t>(mapped));
  EXPECT_TRUE(front_end.finish().path.empty()) << "told once only";
}

TEST(FrontEnd, GravityLevelsTheWorld) {
  FrontEndOptions options;
  options.align = AlignMode::gravity;
  FrontEnd front_end = make_front_end(options, true);
  std::vector<TrajectoryEntry> path;
  for (const StereoFrame& frame : room().frames) {
    for (const auto& entry : front_end.process(frame).path) path.push_back(entry);
  }
  for (const auto& entry : front_end.finish().path) path.push_back(entry);
  ASSERT_FALSE(path.empty());
  const Eigen::Vector3d up_in_camera = room().true_poses[0].linear().row(2).transpose();
  const Eigen::Vector3d up_in_world = path[0].world_from_camera.linear() * up_in_camera;
  EXPECT_LT(std::acos(std::min(1.0, up_in_world.z())) * 57.3, 1.0);
}

TEST(FrontEnd, GravityWithoutASensorIsRefused) {
  FrontEndOptions options;
  options.align = AlignMode::gravity;
  EXPECT_THROW(make_front_end(options), std::runtime_error);
}

TEST(FrontEnd, ResetStartsWhereItFirstStarted) {
  FrontEndOptions options;
  options.first_world_from_camera = room().true_poses.front();
  FrontEnd front_end = make_front_end(options);
  std::vector<SE3> first;
  for (const StereoFrame& frame : room().frames) first.push_back(*front_end.process(frame).world_from_camera);
  front_end.reset();
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto again = front_end.process(room().frames[i]).world_from_camera;
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->matrix() == first[i].matrix()) << "frame " << i;
  }
}

TEST(FrontEnd, GivenPosesReplaceOdometry) {
  const GivenPoses poses({{room().frames[0].timestamp_ns, room().true_poses[0]}}, SE3::Identity());
  FrontEnd front_end({}, Rectifier(room().calibration), poses, std::nullopt);
  EXPECT_TRUE(front_end.process(room().frames[0]).world_from_camera->isApprox(room().true_poses[0]));
  const FrontEndResult none = front_end.process(room().frames[5]);
  EXPECT_FALSE(none.world_from_camera);
  EXPECT_FALSE(none.tracking.reason.empty());
}

}  // namespace
}  // namespace flogmap
