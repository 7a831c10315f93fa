// What is written is what is read.
#include "camera/recording_writer.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "camera/picture_files.hpp"
#include "camera/rectifier.hpp"
#include "camera/simulated_source.hpp"
#include "camera/simulation/occupancy.hpp"
#include "camera/simulation/simulate_recording.hpp"
#include "camera/source_spec.hpp"
#include "tests/camera/small_scene.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

StereoCalibration bent_pair() {
  StereoCalibration calibration;
  calibration.left = {48,    32,   40.123456789012345, 41.5,
                      23.25, 15.5, Distortion::radtan, {-0.1, 0.02, 0.001, -0.002}};
  calibration.right = {
      48, 32, 40.5, 41.25, 23.75, 15.25, Distortion::radtan, {-0.11, 0.03, 0.0, 0.001, 0.0001}};
  calibration.right_from_left.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, -1).normalized()));
  calibration.right_from_left.translation() = Eigen::Vector3d(-0.1, 0.002, 0.003);
  calibration.body_from_left.rotate(Eigen::AngleAxisd(1.2, Eigen::Vector3d(-1, 2, 1).normalized()));
  calibration.body_from_left.translation() = Eigen::Vector3d(0.3, 0.2, 0.1);
  return calibration;
}

StereoFrame random_frame(std::int64_t time_ns, std::mt19937& random, int channels = 1, int bits = 8) {
  StereoFrame frame{time_ns, {48, 32, channels, bits, {}}, {48, 32, channels, bits, {}}};
  for (Picture* picture : {&frame.left, &frame.right}) {
    picture->bytes.resize(static_cast<std::size_t>(48) * 32 * channels * bits / 8);
    for (std::uint8_t& byte : picture->bytes) byte = static_cast<std::uint8_t>(random());
  }
  return frame;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(RecordingWriter, FramesAndCalibrationComeBackBitForBit) {
  for (const bool compress : {true, false}) {
    for (const auto& [channels, bits] : {std::pair(1, 8), {3, 8}, {1, 16}}) {
      const testing::TemporaryFolder folder;
      std::mt19937 random(3);
      std::vector<StereoFrame> frames;
      RecordingWriter writer(folder.path(), bent_pair(), {.compress = compress, .rate_hz = 10});
      for (int i = 0; i < 4; ++i) {
        frames.push_back(random_frame(1'700'000'000'123'456'789 + i * 100'000'001LL, random, channels, bits));
        writer.write(frames.back());
      }
      const auto source = open_source({.spec = "euroc:" + folder.path().string()});
      for (const StereoFrame& frame : frames) {
        const auto read = source->next();
        ASSERT_TRUE(read);
        EXPECT_EQ(read->timestamp_ns, frame.timestamp_ns);
        EXPECT_EQ(read->left, frame.left);
        EXPECT_EQ(read->right, frame.right);
      }
      EXPECT_FALSE(source->next());
      const StereoCalibration c = *source->calibration(), expected = bent_pair();
      EXPECT_EQ(c.left.fx_px, expected.left.fx_px);
      EXPECT_EQ(c.right.coefficients, expected.right.coefficients);
      EXPECT_TRUE(c.right_from_left.isApprox(expected.right_from_left, 1e-14));
      EXPECT_TRUE(c.body_from_left.isApprox(expected.body_from_left, 1e-14));
    }
  }
}

TEST(RecordingWriter, ARectifiedPairStaysOne) {
  StereoCalibration shifted = bent_pair();
  for (CameraIntrinsics* camera : {&shifted.left, &shifted.right}) {
    camera->fx_px = camera->fy_px = 40;
    camera->distortion = Distortion::none;
    camera->coefficients.clear();
  }
  shifted.right_from_left = Eigen::Isometry3d(Eigen::Translation3d(-0.1, 0, 0));
  shifted.rectified = true;
  const testing::TemporaryFolder folder;
  std::mt19937 random(3);
  RecordingWriter(folder.path(), shifted, {}).write(random_frame(5, random));
  const auto source = open_source({.spec = "euroc:" + folder.path().string()});
  EXPECT_TRUE(source->calibration()->rectified);
  EXPECT_EQ(Rectifier(*source->calibration()).camera(), Rectifier(shifted).camera());
}

TEST(RecordingWriter, NeverWritesOverARecording) {
  const testing::TemporaryFolder folder;
  RecordingWriter first(folder.path(), bent_pair(), {});
  EXPECT_THROW(RecordingWriter(folder.path(), bent_pair(), {}), std::runtime_error);
  EXPECT_THROW(RecordingWriter("/proc/nothing/here", bent_pair(), {}), std::runtime_error);
}

TEST(RecordingWriter, TimesLoseNoNanosecond) {
  EXPECT_EQ(seconds_text(1'700'000'000'000'000'001), "1700000000.000000001");
  EXPECT_EQ(seconds_text(50), "0.000000050");
}

TEST(Simulation, WhatIsBrokenOffLeavesNothingThatBlocksItsName) {
  const testing::TemporaryFolder folder;
  const Scene scene = testing::small_scene();
  const SimulationOptions options{.seed = 4, .num_frames = 3, .num_depth_views = 1};
  const auto stop = [](std::int64_t, std::int64_t) { throw std::runtime_error("stop"); };
  EXPECT_THROW(simulate_recording(scene, folder.path(), options, stop), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  std::ofstream(folder.path() / "notes.txt") << "mine";
  EXPECT_THROW(simulate_recording(scene, folder.path(), options, stop), std::runtime_error);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "notes.txt"));
  EXPECT_NO_THROW(simulate_recording(scene, folder.path(), options, {}));
  EXPECT_THROW(simulate_recording(scene, folder.path(), options, {}), std::runtime_error);
  EXPECT_TRUE(
      std::filesystem::exists(folder.path() / "mav0" / "cam0" / "data.csv"));  // the finished one stays
}

TEST(Simulation, ARecordingHasItsPicturesPosesDepthAndTruth) {
  const testing::TemporaryFolder folder;
  Scene scene = testing::small_scene();
  scene.truth.min_m = {-2.2, -2.2};
  scene.truth.max_m = {2.2, 2.2};
  std::int64_t done = 0;
  simulate_recording(scene, folder.path(), {.seed = 4, .num_frames = 6, .num_depth_views = 2},
                     [&](std::int64_t now, std::int64_t all) { done = now + all; });
  EXPECT_EQ(done, 12);
  const auto recorded = open_source({.spec = "euroc:" + folder.path().string()});
  SimulatedSource live("sim:small", scene, 4);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(recorded->next()->left, live.next()->left);
  EXPECT_FALSE(recorded->next());
  EXPECT_TRUE(Rectifier(*recorded->calibration()).camera() == scene.camera);

  std::istringstream tum(text_of(folder.path() / "groundtruth.tum"));
  std::string time;
  Eigen::Vector3d p;
  Eigen::Quaterniond q;
  tum >> time >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
  const Eigen::Isometry3d first = *live.true_pose(live.info().first_timestamp_ns);
  EXPECT_LT((p - first.translation()).norm(), 1e-8);
  EXPECT_TRUE(q.toRotationMatrix().isApprox(first.linear(), 1e-7));

  for (const char* name :
       {"truth/layer_0.png", "truth/layer_2.json", "truth/seen_1.png", "depth/1700000000000000000.pfm",
        "disparity/1700000000300000000.pfm", "mav0/state_groundtruth_estimate0/data.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  }
  const Picture truth = read_picture(folder.path() / "truth/layer_0.png").picture;
  const Image<std::uint8_t> expected = true_occupancy(scene, 0.05, 0.75, 0);
  EXPECT_EQ(truth.bytes, expected.pixels);
}

TEST(Simulation, PfmHoldsTheFloatsLowestRowFirst) {
  const testing::TemporaryFolder folder;
  Image<float> image(2, 2);
  image.pixels = {1.5F, INFINITY, -2.25F, 3e-7F};
  write_pfm(folder.path() / "a.pfm", image);
  const std::string text = text_of(folder.path() / "a.pfm");
  const std::string header = "Pf\n2 2\n-1.0\n";
  ASSERT_EQ(text.size(), header.size() + 16);
  EXPECT_TRUE(text.starts_with(header));
  float lowest_left = 0;
  std::memcpy(&lowest_left, text.data() + header.size(), 4);
  EXPECT_EQ(lowest_left, -2.25F);
}

}  // namespace
}  // namespace flogmap
