// Whatever two cameras do, pairs are right, in order, and none is lost that could be had.
#include <gmock/gmock.h>

#include <cstdlib>
#include <random>
#include <vector>

#include "camera/frame_pairing.hpp"

namespace flogmap {
namespace {

constexpr unsigned kSeed = 20261122;
constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod = 50 * kMs;

struct Arrival {
  Side side;
  std::int64_t taken_ns;    // by the shared clock
  std::int64_t arrives_ns;  // transfer takes its time
  std::uint8_t exposure;    // which instant of the world it shows
};

Picture marked(std::uint8_t exposure) { return {1, 1, 1, 8, {exposure}}; }

/// Offers everything in the order of arrival; returns the pairs.
std::vector<PairedPictures> pair_all(FramePairing& pairing, std::vector<Arrival> arrivals) {
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.arrives_ns < b.arrives_ns; });
  std::vector<PairedPictures> pairs;
  for (const Arrival& arrival : arrivals) {
    if (auto pair = pairing.offer(arrival.side, {arrival.taken_ns, marked(arrival.exposure)}))
      pairs.push_back(std::move(*pair));
  }
  return pairs;
}

void expect_right_and_in_order(const std::vector<PairedPictures>& pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(pairs[i].left.picture, pairs[i].right.picture) << "pair " << i;
    if (i > 0) {
      EXPECT_GT(pairs[i].left.timestamp_ns, pairs[i - 1].left.timestamp_ns);
    }
  }
}

/// Frames of both cameras with jitter of exposure and transfer; a share of them never arrives.
std::vector<Arrival> jittery(int count, std::int64_t jitter_ns, double dropped, std::vector<bool>& both) {
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<std::int64_t> jitter(-jitter_ns, jitter_ns), transfer(5 * kMs, 30 * kMs);
  std::bernoulli_distribution lost(dropped);
  std::vector<Arrival> arrivals;
  for (int i = 0; i < count; ++i) {
    bool complete = true;
    for (const Side side : {Side::left, Side::right}) {
      const std::int64_t taken = i * kPeriod + jitter(random), arrives = taken + transfer(random);
      if (lost(random))
        complete = false;
      else
        arrivals.push_back({side, taken, arrives, static_cast<std::uint8_t>(i)});
    }
    both.push_back(complete);
  }
  return arrivals;
}

TEST(FramePairing, JitterOfExposureAndTransferCostsNoPair) {
  std::vector<bool> both;
  FramePairing pairing({.period_ns = kPeriod, .max_skew_ns = 5 * kMs});
  const auto pairs = pair_all(pairing, jittery(2000, 2 * kMs, 0, both));
  EXPECT_EQ(pairs.size(), 2000U);
  expect_right_and_in_order(pairs);
  EXPECT_EQ(pairing.counts().alone_left + pairing.counts().alone_right, 0);
}

TEST(FramePairing, ADroppedFrameCostsItsOwnPairAndNoOther) {
  std::vector<bool> both;
  FramePairing pairing({.period_ns = kPeriod, .max_skew_ns = 5 * kMs});
  const auto pairs = pair_all(pairing, jittery(2000, 2 * kMs, 0.2, both));
  expect_right_and_in_order(pairs);
  EXPECT_EQ(std::ssize(pairs), std::count(both.begin(), both.end(), true));
  EXPECT_GT(pairing.counts().alone_left, 100);
  EXPECT_GT(pairing.counts().alone_right, 100);
}

TEST(FramePairing, ADriftOf100PpmLosesOnlyPairsThatAreTooFarApart) {
  // Without a servo the right camera, 100 ppm slow, falls behind by a whole frame every 10,000 frames.
  FramePairing pairing({.period_ns = kPeriod, .max_skew_ns = 5 * kMs});
  std::vector<Arrival> arrivals;
  constexpr std::int64_t kFrames = 20'000;
  for (std::int64_t i = 0; i < kFrames; ++i) {
    const std::int64_t right = i * kPeriod + i * kPeriod / 10'000;
    arrivals.push_back({Side::left, i * kPeriod, i * kPeriod, 0});
    arrivals.push_back({Side::right, right, right, 0});
  }
  const auto pairs = pair_all(pairing, arrivals);
  for (const PairedPictures& pair : pairs) EXPECT_LE(std::abs(pair.skew_ns()), 5 * kMs);
  // The skew runs evenly through -25 to 25 ms, so a fifth of all pairs are within 5 ms.
  EXPECT_NEAR(static_cast<double>(pairs.size()) / kFrames, 0.2, 0.01);
  EXPECT_GT(pairing.counts().too_skewed, kFrames / 2);
}

TEST(FramePairing, ACameraThatStartsAnewIsPairedAgainAtOnce) {
  FramePairing pairing({.period_ns = kPeriod, .max_skew_ns = 5 * kMs});
  std::vector<Arrival> arrivals;
  for (int i = 0; i < 100; ++i) {
    arrivals.push_back({Side::left, i * kPeriod, i * kPeriod, static_cast<std::uint8_t>(i)});
    if (i < 30 || i >= 60)  // gone for 30 frames, back with another phase
      arrivals.push_back({Side::right, i * kPeriod + (i < 30 ? 0 : 3 * kMs), i * kPeriod + 4 * kMs,
                          static_cast<std::uint8_t>(i)});
  }
  const auto pairs = pair_all(pairing, arrivals);
  EXPECT_EQ(pairs.size(), 70U);
  expect_right_and_in_order(pairs);
  EXPECT_EQ(pairing.counts().alone_left, 30);
}

TEST(FramePairing, AClockThatStepsBackNeverMakesTimesStepBack) {
  FramePairing pairing({.period_ns = kPeriod, .max_skew_ns = 5 * kMs});
  std::vector<PairedPictures> pairs;
  for (const std::int64_t start : {1000 * kPeriod, 990 * kPeriod}) {  // both begin again, ten frames earlier
    for (int i = 0; i < 20; ++i) {
      for (const Side side : {Side::left, Side::right}) {
        if (auto pair = pairing.offer(side, {start + i * kPeriod, marked(0)})) pairs.push_back(*pair);
      }
    }
  }
  expect_right_and_in_order(pairs);
  EXPECT_EQ(pairs.size(), 20U);
}

TEST(FramePairing, NeverHoldsMoreThanItsBound) {
  FramePairing pairing({.period_ns = kPeriod, .max_skew_ns = 5 * kMs, .max_waiting = 4});
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(pairing.offer(Side::left, {i * kPeriod, marked(0)}));
  EXPECT_EQ(pairing.counts().alone_left, 996);
}

TEST(FramePairing, EverySkewIsCountedInItsBin) {
  SkewHistogram histogram;
  for (const double ms : {0.05, -0.15, 4.0, -4.0, 60.0}) histogram.add(static_cast<std::int64_t>(ms * kMs));
  EXPECT_EQ(histogram.total(), 5);
  EXPECT_THAT(histogram.counts, ::testing::ElementsAre(1, 1, 0, 0, 0, 2, 0, 0, 0, 1));
  EXPECT_NEAR(histogram.sum_ms, 68.2, 1e-6);
}

/// Two free-running cameras, the right one steered; a new duration takes effect `latency` frames later and is
/// rounded to the sensor's line time. Returns the skew of each frame.
std::vector<std::int64_t> steer(std::int64_t first_skew_ns, double drift_ppm, std::int64_t jitter_ns,
                                int latency, int frames) {
  constexpr std::int64_t kLineNs = 15'000;
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<std::int64_t> jitter(-jitter_ns, jitter_ns);
  FrameServo servo(kPeriod);
  std::deque<std::int64_t> on_the_way(static_cast<std::size_t>(latency), kPeriod);
  std::int64_t skew = first_skew_ns;
  std::vector<std::int64_t> skews;
  for (int i = 0; i < frames; ++i) {
    skews.push_back(skew);
    on_the_way.push_back(servo.duration_for(skew + jitter(random)));
    const std::int64_t duration = (on_the_way.front() + kLineNs / 2) / kLineNs * kLineNs;
    on_the_way.pop_front();
    skew += static_cast<std::int64_t>(static_cast<double>(duration) * (1 + 1e-6 * drift_ppm)) - kPeriod;
  }
  return skews;
}

TEST(FrameServo, BringsTheCamerasIntoStepAndKeepsThemThere) {
  for (const double drift_ppm : {-100.0, 0.0, 100.0}) {
    for (const std::int64_t first : {-24 * kMs, 3 * kMs, 24 * kMs}) {
      const auto skews = steer(first, drift_ppm, 50'000, 4, 2000);
      for (std::size_t i = 600; i < skews.size(); ++i)
        ASSERT_LT(std::abs(skews[i]), 300'000) << drift_ppm << " ppm, frame " << i;
    }
  }
}

TEST(FrameServo, NeverAsksForMoreThanTwoPercent) {
  FrameServo servo(kPeriod);
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t duration = servo.duration_for((i % 3 - 1) * 25 * kMs);
    EXPECT_LE(std::abs(duration - kPeriod), kPeriod / 50);
  }
}

}  // namespace
}  // namespace flogmap
