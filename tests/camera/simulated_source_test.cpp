#include "camera/simulated_source.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "camera/rectifier.hpp"
#include "camera/source_spec.hpp"
#include "tests/camera/small_scene.hpp"

namespace flogmap {
namespace {

TEST(SimulatedSource, TheSameSeedGivesTheSameFramesAndAnotherSeedOthers) {
  Scene scene = testing::small_scene();
  scene.sensor = {
      .noise_grey = 2, .blur_px = 0.5, .right_gain = 1.1, .drop_probability = 0.2, .skew_s = 0.01};
  SimulatedSource a("sim:a", scene, 7), b("sim:b", scene, 7), c("sim:c", scene, 8);
  bool any_difference = false;
  for (int i = 0; i < 10; ++i) {
    const auto fa = a.next(), fb = b.next(), fc = c.next();
    ASSERT_TRUE(fa && fb && fc);
    EXPECT_EQ(fa->timestamp_ns, fb->timestamp_ns);
    EXPECT_EQ(fa->left, fb->left);
    EXPECT_EQ(fa->right, fb->right);
    any_difference |= fa->left != fc->left;
  }
  EXPECT_TRUE(any_difference);
}

TEST(SimulatedSource, DroppedPairsAreCountedAndTimesStillIncrease) {
  Scene scene = testing::small_scene();
  scene.sensor.drop_probability = 0.4;
  SimulatedSource source("sim:small", scene, 1);
  std::int64_t last = 0;
  for (int i = 0; i < 30; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_GT(frame->timestamp_ns, last);
    last = frame->timestamp_ns;
  }
  EXPECT_GT(source.skipped().count, 5);
  EXPECT_THAT(source.skipped().last_reason, ::testing::HasSubstr("dropped"));
}

TEST(SimulatedSource, GainAndNoiseAreWhatTheSceneSays) {
  Scene scene = testing::small_scene();
  SimulatedSource plain("sim:small", scene, 1);
  scene.sensor.noise_grey = 3;
  SimulatedSource noisy("sim:small", scene, 1);
  scene.sensor = {.right_gain = 0.8};
  SimulatedSource dim("sim:small", scene, 1);
  const auto clean = plain.next(), rough = noisy.next(), dimmed = dim.next();
  double squares = 0, bright = 0, dark = 0;
  for (std::size_t i = 0; i < clean->left.bytes.size(); ++i) {
    squares += std::pow(rough->left.bytes[i] - clean->left.bytes[i], 2);
    bright += clean->right.bytes[i];
    dark += dimmed->right.bytes[i];
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(clean->left.bytes.size())), 3, 0.15);
  EXPECT_NEAR(dark / bright, 0.8, 0.01);
  EXPECT_EQ(clean->left, dimmed->left);
}

TEST(SimulatedSource, SeekGoesToTheFirstFrameAtOrAfterATime) {
  SimulatedSource source("sim:small", testing::small_scene(), 1);
  const std::int64_t start = source.info().first_timestamp_ns;
  for (const std::int64_t offset : {0L, 1L, 100'000'000L, 250'000'000L}) {
    ASSERT_TRUE(source.seek(start + offset));
    const std::int64_t time = source.next()->timestamp_ns;
    EXPECT_GE(time, start + offset);
    EXPECT_LT(time, start + offset + 100'000'000);
  }
}

TEST(SimulatedSource, StopEndsIt) {
  SimulatedSource source("sim:small", testing::small_scene(), 1);
  EXPECT_TRUE(source.next());
  source.stop();
  EXPECT_FALSE(source.next());
}

TEST(SimulatedSource, UpIsTheWorldsZInTheFirstCamera) {
  SimulatedSource source("sim:small", testing::small_scene(), 1);
  const Eigen::Isometry3d first = *source.true_pose(source.info().first_timestamp_ns);
  EXPECT_TRUE((first.linear() * *source.up_in_left_camera()).isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(SimulatedSource, PicturesPassTheRectifierUntouched) {
  SimulatedSource source("sim:small", testing::small_scene(), 1);
  const Rectifier rectifier(*source.calibration());
  EXPECT_EQ(rectifier.camera(), source.scene().camera);
  const auto frame = source.next();
  EXPECT_EQ(rectifier.rectify(*frame).left.pixels, frame->left.bytes);
}

TEST(SourceSpec, NamesTheKindsThereAre) {
  for (const char* spec : {"", "sim", "sim:", "nonsense:/tmp", "/tmp", "euroc"}) {
    try {
      static_cast<void>(open_source({.spec = spec}));
      ADD_FAILURE() << spec;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("euroc:DIR")) << spec;
      EXPECT_THAT(error.what(), ::testing::Not(::testing::HasSubstr("\n")));
    }
  }
}

TEST(SourceSpec, AnUnknownSceneIsNamed) {
  EXPECT_THAT([] { static_cast<void>(open_source({.spec = "sim:atlantis"})); },
              ::testing::ThrowsMessage<std::runtime_error>(
                  ::testing::AllOf(::testing::HasSubstr("atlantis"), ::testing::HasSubstr("room"))));
}

}  // namespace
}  // namespace flogmap
