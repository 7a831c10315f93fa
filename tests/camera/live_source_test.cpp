// The live source over made-up cameras: pairs, step, exposure, unplugging.
#include <gmock/gmock.h>

#include <deque>
#include <random>
#include <thread>
#include <vector>

#include "camera/live/live_source.hpp"
#include "camera/source_spec.hpp"

namespace flogmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::int64_t kMs = 1'000'000, kPeriod = 50 * kMs;

/// What happened to the cameras, for the test to see; outlives the rig.
struct RigLog {
  std::vector<std::pair<double, double>> exposures;
  std::int64_t right_duration_ns = kPeriod;
  int reopened = 0;
};

/// Two cameras that run by numbers alone: the right one starts late by `skew_ns` and obeys its duration.
class FakeRig final : public CameraRig {
 public:
  FakeRig(RigLog& log, std::int64_t skew_ns, int unplugged_at = -1)
      : log_(log), right_ns_(skew_ns), unplugged_at_(unplugged_at) {}

  std::optional<RigPicture> wait(std::chrono::milliseconds) override {
    if (unplugged_at_ == frame_ && !lost_) {
      lost_ = true;
      tries_ = 2;
    }
    if (lost_ || stopped_) return std::nullopt;
    const bool left = left_ns_ <= right_ns_;
    std::int64_t& time = left ? left_ns_ : right_ns_;
    RigPicture picture{left ? Side::left : Side::right, {time, {1, 1, 1, 8, {7}}}, 1000.0 + frame_ / 20, 2};
    time += left ? kPeriod : log_.right_duration_ns;
    if (left) ++frame_;
    return picture;
  }
  [[nodiscard]] std::string lost() const override { return lost_ ? "camera B was unplugged" : ""; }
  bool reopen() override {
    if (--tries_ > 0) return false;
    ++log_.reopened;
    lost_ = false;
    unplugged_at_ = -1;
    left_ns_ += 40 * kPeriod;
    right_ns_ = left_ns_ + 2 * kMs;
    return true;
  }
  void stop() override { stopped_ = true; }
  [[nodiscard]] bool keeps_step() const override { return false; }
  void set_right_duration(std::int64_t duration_ns) override { log_.right_duration_ns = duration_ns; }
  void set_right_exposure(double exposure_us, double gain) override {
    log_.exposures.emplace_back(exposure_us, gain);
  }

 private:
  RigLog& log_;
  std::int64_t left_ns_ = 0, right_ns_;
  int frame_ = 0, unplugged_at_, tries_ = 0;
  bool lost_ = false;
  std::atomic<bool> stopped_ = false;
};

LiveSource live(RigLog& log, std::int64_t skew_ns, int unplugged_at = -1) {
  return {"libcamera:A,B",
          std::make_unique<FakeRig>(log, skew_ns, unplugged_at),
          std::nullopt,
          {.rate_hz = 20, .max_skew_ms = 5}};
}

TEST(LiveSource, CamerasOutOfStepAreBroughtTogetherAndPairsMeanwhileAreDroppedAndSaid) {
  RigLog log;
  LiveSource source = live(log, 20 * kMs);
  std::int64_t last_ns = -1;
  for (int i = 0; i < 500; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_GT(frame->timestamp_ns, last_ns);
    last_ns = frame->timestamp_ns;
  }
  EXPECT_GT(source.counts().too_skewed, 5);
  EXPECT_LT(source.counts().too_skewed, 100);
  EXPECT_LT(std::abs(source.counts().last_skew_ns), 100'000);
  EXPECT_THAT(source.skipped().last_reason, HasSubstr("--max-skew-ms"));
  ASSERT_TRUE(source.skew());
  EXPECT_NEAR(source.skew()->histogram.largest_ms, 20, 0.5);
  EXPECT_EQ(source.skew()->num_dropped, source.counts().too_skewed);
  EXPECT_EQ(source.skew()->histogram.total(), source.counts().pairs + source.counts().too_skewed);
}

TEST(LiveSource, TheRightCameraIsExposedLikeTheLeftOne) {
  RigLog log;
  LiveSource source = live(log, 0);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(source.next());
  ASSERT_GE(log.exposures.size(), 3U);
  EXPECT_LE(log.exposures.size(), 5U);  // told when it changes, not with every frame
  EXPECT_EQ(log.exposures[1], std::pair(1001.0, 2.0));
}

TEST(LiveSource, ACameraThatIsUnpluggedIsWaitedForAndSaid) {
  RigLog log;
  LiveSource source = live(log, 0, 30);
  std::vector<std::string> told;
  source.on_trouble([&] { told.push_back(source.skipped().last_reason); });
  std::int64_t last_ns = -1;
  for (int i = 0; i < 100; ++i) {
    const auto frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_GT(frame->timestamp_ns, last_ns);
    last_ns = frame->timestamp_ns;
  }
  EXPECT_EQ(log.reopened, 1);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_THAT(told[0], AllOf(HasSubstr("camera B was unplugged"), HasSubstr("waiting")));
  EXPECT_THAT(told[1], AllOf(HasSubstr("camera B was unplugged"), HasSubstr("came back")));
}

TEST(LiveSource, StopEndsItEvenWhileACameraIsGone) {
  RigLog log;
  LiveSource source = live(log, 0, 0);
  std::jthread stopper([&] { source.stop(); });
  while (source.next()) {
  }
  EXPECT_FALSE(source.next());
}

TEST(LiveSource, MistakenSpecsAreNamed) {
  for (const char* spec : {"libcamera:only-one", "libcamera:same,same", "libcamera:,b"}) {
    EXPECT_THAT([&] { (void)open_source({.spec = spec}); },
                ThrowsMessage<std::runtime_error>(HasSubstr("libcamera")));
  }
  // Whether or not this build has libcamera: cameras that are not there are an error in words.
  EXPECT_THAT([] { (void)open_source({.spec = "libcamera:not-there,nor-this"}); },
              ThrowsMessage<std::runtime_error>(
                  ::testing::AnyOf(HasSubstr("no camera 'not-there'"), HasSubstr("libcamera"))));
}

}  // namespace
}  // namespace flogmap
