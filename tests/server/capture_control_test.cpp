#include "server/capture_control.hpp"

#include <gtest/gtest.h>

namespace flogmap {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

SourceInfo recording() {
  SourceInfo info;
  info.spec = "euroc:/recording";
  info.num_frames = 100;
  info.first_timestamp_ns = 5 * kSecond;
  info.last_timestamp_ns = 15 * kSecond;
  return info;
}

SourceInfo camera() {
  SourceInfo info;
  info.spec = "libcamera:l,r";
  info.live = true;
  return info;
}

CaptureControl running(const SourceInfo& info) { return {info, 0, false}; }

TEST(CaptureControl, PositionAndDurationCountFromTheFirstFrame) {
  CaptureControl control = running(recording());
  control.started();
  control.frame_delivered(9 * kSecond);
  EXPECT_TRUE(control.playback().seekable);
  EXPECT_DOUBLE_EQ(control.playback().position_s, 4);
  EXPECT_DOUBLE_EQ(control.playback().duration_s, 10);
}

TEST(CaptureControl, EveryIllegalTransitionIsRefusedWithAReason) {
  CaptureControl control = running(recording());
  EXPECT_EQ(control.pause().outcome, ControlOutcome::illegal);  // not started yet
  control.started();
  EXPECT_EQ(control.resume().outcome, ControlOutcome::illegal);
  EXPECT_EQ(control.step().outcome, ControlOutcome::illegal);
  EXPECT_EQ(control.pause().outcome, ControlOutcome::done);
  const ControlResult again = control.pause();
  EXPECT_EQ(again.outcome, ControlOutcome::illegal);
  EXPECT_FALSE(again.detail.empty());
  EXPECT_EQ(control.resume().outcome, ControlOutcome::done);
  control.finished();
  EXPECT_EQ(control.pause().outcome, ControlOutcome::illegal);
  EXPECT_EQ(control.resume().outcome, ControlOutcome::illegal);
}

TEST(CaptureControl, ALiveSourceIsNeitherReplayedNorStepped) {
  CaptureControl control = running(camera());
  control.started();
  EXPECT_EQ(control.change_playback({.position_s = 1, .rate = {}, .paused = {}}).outcome,
            ControlOutcome::illegal);
  EXPECT_EQ(control.step().outcome, ControlOutcome::illegal);
  EXPECT_EQ(control.pause().outcome, ControlOutcome::done);
  EXPECT_FALSE(control.playback().seekable);
}

TEST(CaptureControl, OneStepReadsOneFrameWhilePaused) {
  CaptureControl control = running(recording());
  control.started();
  ASSERT_EQ(control.pause().outcome, ControlOutcome::done);
  ASSERT_EQ(control.step().outcome, ControlOutcome::done);
  EXPECT_EQ(control.await_turn().kind, CaptureTurn::Kind::read);
  control.drain();  // otherwise the next turn would wait for ever: the step is used up
  EXPECT_EQ(control.await_turn().kind, CaptureTurn::Kind::stop);
}

TEST(CaptureControl, ASeekComesFirstAndShowsOneFrameWhilePaused) {
  CaptureControl control = running(recording());
  control.started();
  ASSERT_EQ(control.pause().outcome, ControlOutcome::done);
  ASSERT_EQ(control.change_playback({.position_s = 2.5, .rate = {}, .paused = {}}).outcome,
            ControlOutcome::done);
  const CaptureTurn turn = control.await_turn();
  EXPECT_EQ(turn.kind, CaptureTurn::Kind::seek);
  EXPECT_DOUBLE_EQ(turn.position_s, 2.5);
  EXPECT_EQ(control.await_turn().kind, CaptureTurn::Kind::read);
  EXPECT_EQ(control.state(), SessionState::paused);
}

TEST(CaptureControl, AResetAfterTheEndRunsAgain) {
  CaptureControl control = running(recording());
  control.started();
  control.finished();
  EXPECT_EQ(control.state(), SessionState::finished);
  EXPECT_EQ(control.reset().outcome, ControlOutcome::done);
  EXPECT_EQ(control.await_turn().kind, CaptureTurn::Kind::reset);
  EXPECT_EQ(control.state(), SessionState::running);
}

TEST(CaptureControl, DrainingWinsOverEverything) {
  CaptureControl control = running(recording());
  control.started();
  ASSERT_EQ(control.reset().outcome, ControlOutcome::done);
  control.drain();
  EXPECT_EQ(control.await_turn().kind, CaptureTurn::Kind::stop);
  control.failed("too late to matter");
  EXPECT_EQ(control.state(), SessionState::draining);
}

}  // namespace
}  // namespace flogmap
