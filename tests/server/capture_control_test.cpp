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

TEST(CaptureControl, ASimulatedWalkHasNoEndButARateAndAPause) {
  SourceInfo walk = recording();
  walk.endless = true;
  walk.num_frames.reset();
  CaptureControl control = running(walk);
  control.started();
  EXPECT_EQ(control.change_playback({.position_s = {}, .rate = 2, .paused = true}).outcome,
            ControlOutcome::done);
  control.frame_delivered(7 * kSecond);
  EXPECT_FALSE(control.playback().seekable);
  EXPECT_TRUE(control.playback().paused);
  EXPECT_DOUBLE_EQ(control.playback().rate, 2);
  EXPECT_DOUBLE_EQ(control.playback().position_s, 2);
}

/// What the capture thread does until it would wait: positions of the frames read.
std::vector<std::int64_t> read_until_rest(CaptureControl& control, std::int64_t next_s) {
  std::vector<std::int64_t> read;
  for (;;) {
    const CaptureTurn turn = control.await_turn();
    if (turn.kind == CaptureTurn::Kind::seek)
      control.hurry_until((5 + std::int64_t(turn.position_s)) * kSecond);
    if (turn.kind == CaptureTurn::Kind::tell) return read;  // it comes to rest
    if (turn.kind != CaptureTurn::Kind::read) continue;
    read.push_back(next_s);
    control.frame_delivered((5 + next_s++) * kSecond);
  }
}

TEST(CaptureControl, SoughtForwardsWhilePausedItGoesThereAndRests) {
  CaptureControl control = running(recording());
  control.started();
  control.frame_delivered(6 * kSecond);
  control.pause();
  EXPECT_TRUE(read_until_rest(control, 2).empty());
  control.change_playback({.position_s = 5, .rate = {}, .paused = {}});
  EXPECT_EQ(read_until_rest(control, 2), (std::vector<std::int64_t>{2, 3, 4, 5}));
  control.step();
  EXPECT_EQ(read_until_rest(control, 6), (std::vector<std::int64_t>{6}));
  EXPECT_EQ(control.state(), SessionState::paused);
}

TEST(CaptureControl, APauseEndsASeekOnItsWay) {
  CaptureControl control = running(recording());
  control.started();
  control.change_playback({.position_s = 8, .rate = {}, .paused = {}});
  EXPECT_EQ(control.await_turn().kind, CaptureTurn::Kind::seek);
  control.hurry_until(13 * kSecond);
  control.frame_delivered(7 * kSecond);
  control.pause();
  EXPECT_TRUE(read_until_rest(control, 3).empty());
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
  control.source_ended(1);
  control.finished(1);
  EXPECT_EQ(control.pause().outcome, ControlOutcome::illegal);
  EXPECT_EQ(control.resume().outcome, ControlOutcome::illegal);
}

TEST(CaptureControl, ARecordingKeepsItsLevelWhenItBeginsAnewACameraDoesNot) {
  const HandLevel wanted{.roll_rad = 0.1, .pitch_rad = 0.2, .yaw_rad = 0.3, .height_m = 0.4};
  CaptureControl replay = running(recording()), live = running(camera());
  for (CaptureControl* control : {&replay, &live}) {
    EXPECT_EQ(control->level(wanted).outcome, ControlOutcome::illegal);  // not started yet
    control->started();
    EXPECT_EQ(control->level(wanted).outcome, ControlOutcome::done);
    EXPECT_EQ(control->levelling().level, wanted);
    EXPECT_EQ(control->await_turn().kind, CaptureTurn::Kind::level);
    EXPECT_EQ(control->await_turn().kind, CaptureTurn::Kind::read);
  }
  EXPECT_EQ(replay.level_of_next_map(), wanted);
  EXPECT_EQ(live.level_of_next_map(), HandLevel{});
}

TEST(CaptureControl, AMapThatCannotBeBuiltAnewIsNotLevelled) {
  CaptureControl control = running(recording());
  std::string obstacle = "its views are gone";
  control.begin_level({}, [&] { return obstacle; });
  control.started();
  EXPECT_EQ(control.level({.height_m = 1}).detail, obstacle);
  EXPECT_EQ(control.levelling().level, HandLevel{});
  obstacle.clear();
  EXPECT_EQ(control.level({.height_m = 1}).outcome, ControlOutcome::done);
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

TEST(CaptureControl, ARecordingHasFinishedWhenItsLastFrameIsMappedNotWhenItIsRead) {
  CaptureControl control = running(recording());
  control.started();
  control.source_ended(1);
  EXPECT_EQ(control.state(), SessionState::running);
  ASSERT_EQ(control.reset().outcome, ControlOutcome::done);
  EXPECT_EQ(control.await_turn().kind, CaptureTurn::Kind::reset);
  control.finished(1);  // of the map before
  EXPECT_EQ(control.state(), SessionState::running);
  control.source_ended(2);
  control.finished(1);
  EXPECT_EQ(control.state(), SessionState::running);
  control.finished(2);
  EXPECT_EQ(control.state(), SessionState::finished);
}

TEST(CaptureControl, AResetAfterTheEndRunsAgain) {
  CaptureControl control = running(recording());
  control.started();
  control.source_ended(1);
  control.finished(1);
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
