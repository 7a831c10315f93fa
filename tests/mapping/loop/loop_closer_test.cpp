#include "mapping/loop/loop_closer.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/mapping/odometry/textured_room.hpp"

namespace flogmap {
namespace {

using namespace test;

constexpr double kPi = std::numbers::pi;

/// Once around on the spot of a small circle, and a bit further: the last views see what the first saw.
/// `num_views` fewer than count: only so many of it.
std::vector<SE3> round_trip(int count, int repeated, int num_views = 1000) {
  std::vector<SE3> poses;
  for (int i = 0; i < std::min(count + repeated, num_views); ++i) {
    const double angle = 2 * kPi * i / count;
    poses.push_back(
        camera_at({0.6 * std::sin(angle), -0.6 * std::cos(angle), 1.3}, angle, 0.05 * std::sin(3 * angle)));
  }
  return poses;
}

/// The same walk as odometry would have it: every step a little wrong in the same way.
std::vector<SE3> drifted(const std::vector<SE3>& truth, const Eigen::Vector3d& metres, double yaw_rad) {
  SE3 error = SE3::Identity();
  error.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  error.translation() = metres;
  std::vector<SE3> poses{truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i)
    poses.push_back(poses.back() * (truth[i - 1].inverse() * truth[i]) * error);
  return poses;
}

constexpr std::int64_t kStep_ns = 500'000'000;

View view_of(const TexturedRoom& room, const SE3& truth, const SE3& odometry, int number, int segment = 0) {
  RenderedFrame frame = room.render(truth);
  return {number * kStep_ns, odometry, std::move(frame.disparity), std::move(frame.pair.left), segment};
}

/// The corrected poses of views 0 to `count` - 1 of segment 0.
std::vector<SE3> corrected(const LoopCorrection& correction, const std::vector<SE3>& odometry, int count) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back(correction.path.map_from_odometry(i * kStep_ns, 0).value() * odometry[i]);
  return poses;
}

double rms_gap(const std::vector<SE3>& a, const std::vector<SE3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i].translation() - b[i].translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(LoopCloser, ClosesARoundTripAndTakesTheDriftAway) {
  const TexturedRoom room;
  const auto truth = round_trip(36, 4);
  const auto odometry = drifted(truth, {0.001, 0.0005, 0.002}, 0.001);
  LoopCloser closer({}, kRoomCamera);
  std::optional<LoopCorrection> last;
  for (int i = 0; i < static_cast<int>(truth.size()); ++i) {
    auto correction = closer.add(view_of(room, truth[i], odometry[i], i));
    if (!correction) continue;
    EXPECT_EQ(correction->timestamp_ns, i * kStep_ns);
    EXPECT_GE(correction->timestamp_ns - correction->met_again_ns, LoopOptions{}.min_views_apart * kStep_ns);
    EXPECT_EQ(correction->path.knots().size(), static_cast<std::size_t>(i + 1));
    last = std::move(correction);
  }
  ASSERT_TRUE(last);
  const int count = static_cast<int>(last->timestamp_ns / kStep_ns) + 1;
  const std::vector<SE3> then(truth.begin(), truth.begin() + count);
  const std::vector<SE3> was(odometry.begin(), odometry.begin() + count);
  const std::vector<SE3> is = corrected(*last, odometry, count);
  EXPECT_LT(rms_gap(is, then), 0.7 * rms_gap(was, then));
  EXPECT_LT((is.back().translation() - then.back().translation()).norm(), 0.01);
}

TEST(LoopCloser, TwoRoomsThatLookTheSameAreNotMerged) {
  const TexturedRoom room;
  const auto first_room = round_trip(20, 0, LoopOptions{}.min_views_apart);  // too few to meet itself
  LoopCloser closer({}, kRoomCamera);
  int number = 0;
  for (const SE3& pose : first_room) EXPECT_FALSE(closer.add(view_of(room, pose, pose, number++)));
  for (int i = 0; i < 20; ++i) {  // a way between them that looks different everywhere
    const SE3 on_the_way = camera_at({0.5 * i - 4, 0, 1.3}, 0);
    const TexturedRoom other{.seed = 100 + i};
    EXPECT_FALSE(closer.add(view_of(other, camera_at({0, 0, 1.3}, 0.3 * i), on_the_way, number++)));
  }
  SE3 shifted = SE3::Identity();
  shifted.translation() = Eigen::Vector3d(8, 0, 0);
  for (const SE3& pose : first_room) EXPECT_FALSE(closer.add(view_of(room, pose, shifted * pose, number++)));
  EXPECT_EQ(closer.num_loops(), 0);
}

TEST(LoopCloser, DifferentRoomsGiveNoLoop) {
  LoopCloser closer({}, kRoomCamera);
  const auto poses = round_trip(20, 0, LoopOptions{}.min_views_apart);
  int number = 0;
  for (const std::int64_t seed : {1, 2, 3}) {
    const TexturedRoom room{.seed = seed};
    for (const SE3& pose : poses) EXPECT_FALSE(closer.add(view_of(room, pose, pose, number++)));
  }
}

TEST(LoopCloser, SegmentAfterALossIsJoinedWhereItBelongs) {
  const TexturedRoom room;
  const auto truth = round_trip(36, 0);
  LoopCloser closer({}, kRoomCamera);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(closer.add(view_of(room, truth[i], truth[i], i)));
  // Carried back to the start while lost, for ten seconds: odometry goes on from where it was last.
  const SE3 wrong = truth[19] * truth[2].inverse();
  for (int i = 2; i < 8; ++i) {
    const View view = view_of(room, truth[i], wrong * truth[i], 40 + i, 1);
    const auto joined = closer.add(view);
    if (!joined) continue;
    for (int k = 2; k <= i; ++k) {
      const SE3 pose = joined->path.map_from_odometry((40 + k) * kStep_ns, 1).value() * wrong * truth[k];
      EXPECT_LT((pose.translation() - truth[k].translation()).norm(), 0.02);
      EXPECT_LT(angle_deg(pose.inverse() * truth[k]), 0.5);
    }
    EXPECT_FALSE(joined->path.map_from_odometry(view.timestamp_ns, 2))
        << "nothing is known of later segments";
    return;
  }
  FAIL() << "not joined";
}

TEST(LoopCloser, NobodyIsCarriedFasterThanTheyCanWalk) {
  const TexturedRoom room;
  const auto truth = round_trip(36, 0);
  LoopCloser closer({}, kRoomCamera);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(closer.add(view_of(room, truth[i], truth[i], i)));
  SE3 far_away = SE3::Identity();
  far_away.translation() = Eigen::Vector3d(30, 0, 0);
  for (int i = 2; i < 8; ++i)
    EXPECT_FALSE(closer.add(view_of(room, truth[i], far_away * truth[i], 18 + i, 1)));
}

TEST(LoopCloser, ForgetsTheOldestAndStillClosesLoopsWithTheRest) {
  const TexturedRoom room;
  const auto truth = round_trip(36, 16);
  const auto odometry = drifted(truth, {0.001, 0.0005, 0.002}, 0.001);
  LoopOptions options;
  options.max_views = 46;  // the first 23 go when view 46 comes; by then it has met views 0 to 9
  LoopCloser closer(options, kRoomCamera);
  std::optional<LoopCorrection> last;
  for (int i = 0; i < static_cast<int>(truth.size()); ++i) {
    auto correction = closer.add(view_of(room, truth[i], odometry[i], i));
    if (correction) last = std::move(correction);
  }
  ASSERT_TRUE(last);
  const int count = static_cast<int>(last->timestamp_ns / kStep_ns) + 1;
  EXPECT_EQ(last->path.knots().size(), static_cast<std::size_t>(count));
  const std::vector<SE3> is = corrected(*last, odometry, count);
  EXPECT_LT((is.back().translation() - truth[count - 1].translation()).norm(), 0.02);
}

TEST(PlaceIndex, FindsTheViewThatSharesPatchesAndNoOther) {
  std::mt19937_64 random(6);
  const auto random_patches = [&] {
    std::vector<BinaryPatch> patches(100);
    for (BinaryPatch& p : patches) p = {random(), random(), random(), random()};
    return patches;
  };
  PlaceIndex index;
  std::vector<std::vector<BinaryPatch>> views;
  for (int v = 0; v < 30; ++v) {
    views.push_back(random_patches());
    index.add(views.back());
  }
  auto seen_again = views[17];
  for (BinaryPatch& p : seen_again) {
    for (int flips = 0; flips < 25; ++flips) p[random() % 4] ^= std::uint64_t{1} << (random() % 64);
  }
  const auto found = index.query(seen_again, index.num_views(), 3);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().view, 17);
  EXPECT_GT(found.front().votes, 60);
  if (found.size() > 1) {
    EXPECT_LT(found[1].votes, 5);
  }
  for (const PlaceCandidate& c : index.query(seen_again, 17, 3)) EXPECT_LT(c.view, 17);
  index.forget_oldest(10);
  EXPECT_EQ(index.num_views(), 20);
  EXPECT_EQ(index.query(seen_again, index.num_views(), 1).at(0).view, 7);
}

}  // namespace
}  // namespace flogmap
