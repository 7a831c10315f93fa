// Loss and return on real and rendered recordings, through the whole chain.
#include <gtest/gtest.h>

#include <algorithm>

#include "camera/source_spec.hpp"
#include "mapping/odometry/trajectory_error.hpp"
#include "tests/server/mapped_path.hpp"
#include "tests/support/recordings.hpp"

namespace flogmap {
namespace {

/// Frames [from, to) of a recording come from a covered lens.
struct Cover {
  int from = 0;
  int to = 0;
};

class CoveredSource final : public StereoSource {
 public:
  CoveredSource(std::unique_ptr<StereoSource> source, Cover cover)
      : source_(std::move(source)), cover_(cover) {}

  std::optional<StereoFrame> next() override {
    std::optional<StereoFrame> frame = source_->next();
    if (frame && number_ >= cover_.from && number_ < cover_.to) {
      std::ranges::fill(frame->left.bytes, std::uint8_t{3});
      std::ranges::fill(frame->right.bytes, std::uint8_t{3});
    }
    ++number_;
    return frame;
  }
  void stop() override { source_->stop(); }
  [[nodiscard]] SourceInfo info() const override { return source_->info(); }
  [[nodiscard]] std::optional<StereoCalibration> calibration() const override {
    return source_->calibration();
  }

 private:
  std::unique_ptr<StereoSource> source_;
  Cover cover_;
  int number_ = 0;
};

std::unique_ptr<MappedPath> map_covered(const std::filesystem::path& folder, Cover cover) {
  auto source =
      open_source({.spec = "euroc:" + folder.string(), .calibration_file = {}, .loop = false, .seed = 1});
  FrontEndOptions options;
  options.align = AlignMode::none;
  return map_path(std::make_unique<CoveredSource>(std::move(source), cover), options, std::nullopt,
                  FlogOptions{}, LoopOptions{});
}

/// How far the poses from which the map was drawn are from the truth.
double worst_mapped_pose_m(const std::vector<TrajectoryEntry>& path, const std::filesystem::path& truth) {
  Trajectory mapped;
  for (const TrajectoryEntry& entry : path) {
    if (entry.mapped) mapped.poses.push_back({entry.timestamp_ns, entry.world_from_camera});
  }
  return evaluate_trajectory(mapped, read_trajectory(truth)).ate_max_m;
}

TEST(PipelineRecordings, ACoveredLensIsSaidToBeLostAndFoundAgainWithNoWallInTheWrongPlace) {
  const auto folder = recording("euroc_mh01_10hz");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with euroc_mh01_10hz";
  constexpr Cover kTwoSeconds{50, 70};
  const auto mapped = map_covered(*folder, kTwoSeconds);
  const auto& reports = mapped->witness.reports;
  ASSERT_EQ(reports.size(), 110U);
  for (int i = 0; i < 110; ++i) {
    if (i < kTwoSeconds.from || i >= kTwoSeconds.to + 5) {
      EXPECT_TRUE(reports[i].tracking.has_pose()) << "frame " << i;
    }
    if (i >= kTwoSeconds.from + 2 && i < kTwoSeconds.to) {
      EXPECT_EQ(reports[i].tracking.state, TrackingState::lost) << "frame " << i;
      EXPECT_FALSE(reports[i].mapped) << "frame " << i;
      EXPECT_NE(reports[i].tracking.reason.find("dark"), std::string::npos) << reports[i].tracking.reason;
    }
  }
  EXPECT_LE(worst_mapped_pose_m(mapped->witness.path, *folder / "groundtruth_cam0.tum"), 0.02);
}

TEST(PipelineRecordings, AStretchThatIsFoundNowhereWaitsUntilItsPlaceIsRecognised) {
  const auto folder = recording("house-dev");
  if (!folder) GTEST_SKIP() << "needs FLOGMAP_DATA with house-dev";
  constexpr Cover kCovered{100, 120};  // the camera walks on meanwhile, and nothing looks known then
  const auto mapped = map_covered(*folder, kCovered);
  const auto& reports = mapped->witness.reports;
  ASSERT_EQ(reports.size(), 320U);
  EXPECT_FALSE(reports[130].world_from_camera) << "its place is not known, so it has no pose in the map";
  EXPECT_EQ(reports[130].tracking.state, TrackingState::lost);
  EXPECT_FALSE(reports[130].tracking.reason.empty());
  EXPECT_TRUE(reports.back().world_from_camera) << "back at the start, the place is known again";
  EXPECT_GT(mapped->status.loops, 0U);
  EXPECT_EQ(mapped->status.waiting_views, 0U);
  EXPECT_EQ(mapped->status.tracked, mapped->witness.path.size())
      << "those that waited have found their place";
  EXPECT_GE(mapped->witness.path.size(), 290U);
  EXPECT_LE(worst_mapped_pose_m(mapped->witness.path, *folder / "groundtruth.tum"), 0.05);
}

}  // namespace
}  // namespace flogmap
