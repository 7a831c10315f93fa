#include "server/pipeline.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "camera/source_spec.hpp"
#include "tests/support/memory_source.hpp"

namespace flogmap {
namespace {

constexpr int kFrames = 8;

/// Writes down what it hears, and lets the test wait for it.
class Witness final : public PipelineObserver {
 public:
  void map_begins(const MapBegin& begin) override {
    const std::scoped_lock lock(mutex);
    begins.push_back(begin);
    tiles_since_begin = 0;
    poses_since_begin = 0;
    changed.notify_all();
  }
  void map_changed(std::uint64_t revision, const std::vector<TileUpdate>& updates) override {
    const std::scoped_lock lock(mutex);
    EXPECT_FALSE(begins.empty());
    for (const TileUpdate& update : updates) EXPECT_EQ(update.revision, revision);
    tiles_since_begin += updates.size();
    changed.notify_all();
  }
  void path_grew(const std::vector<TrajectoryEntry>& entries) override {
    const std::scoped_lock lock(mutex);
    EXPECT_FALSE(begins.empty());
    for (const TrajectoryEntry& entry : entries) path.push_back(entry);
    poses_since_begin += entries.size();
    changed.notify_all();
  }
  void frame_tracked(const TrackingReport& /*report*/) override {
    const std::scoped_lock lock(mutex);
    ++frames;
    changed.notify_all();
  }
  void pictures_taken(const PictureReport& /*report*/) override {}
  void status_changed(const StatusReport& report) override {
    const std::scoped_lock lock(mutex);
    status = report;
    changed.notify_all();
  }

  template <typename Condition>
  void wait_until(Condition condition) {
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(60), condition));
  }

  std::mutex mutex;
  std::condition_variable changed;
  std::vector<MapBegin> begins;
  std::vector<TrajectoryEntry> path;
  std::size_t tiles_since_begin = 0;
  std::size_t poses_since_begin = 0;
  int frames = 0;
  StatusReport status;
};

/// A camera pair of which one is unplugged before the first frame; stop() ends the waiting.
class UnpluggedSource final : public StereoSource {
 public:
  explicit UnpluggedSource(std::unique_ptr<StereoSource> recording) : recording_(std::move(recording)) {}
  std::optional<StereoFrame> next() override {
    tell_();
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return stopped_; });
    return std::nullopt;
  }
  void stop() override {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
    ended_.notify_all();
  }
  void on_trouble(std::function<void()> tell) override { tell_ = std::move(tell); }
  [[nodiscard]] SourceInfo info() const override {
    return {.spec = "cameras", .live = true, .endless = true, .num_frames = std::nullopt};
  }
  [[nodiscard]] std::optional<StereoCalibration> calibration() const override {
    return recording_->calibration();
  }
  [[nodiscard]] SkippedFrames skipped() const override { return {0, "camera B was unplugged"}; }

 private:
  std::unique_ptr<StereoSource> recording_;
  std::function<void()> tell_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool stopped_ = false;
};

std::unique_ptr<Pipeline> make_pipeline(PipelineObserver& observer, bool end_with_source, int fail_at = -1) {
  static const auto recorded = record_frames(
      *open_source({.spec = "sim:room", .calibration_file = {}, .loop = false, .seed = 1}), kFrames);
  auto source = std::make_unique<MemorySource>(recorded);
  if (fail_at >= 0) source->fail_at(static_cast<std::size_t>(fail_at));
  FrontEndOptions options;
  options.first_world_from_camera = recorded->first_pose;
  FrontEnd front_end(options, Rectifier(*source->calibration()), std::nullopt, std::nullopt);
  MapIntegrator integrator(FlogOptions{}, front_end.camera(), front_end.max_disparity_px());
  PipelineOptions pipeline_options;
  pipeline_options.rate = 0;
  pipeline_options.end_with_source = end_with_source;
  return std::make_unique<Pipeline>(pipeline_options, std::move(source), std::move(front_end),
                                    std::move(integrator), observer);
}

TEST(Pipeline, EveryFrameIsTrackedAndTheMapGrows) {
  Witness witness;
  const auto pipeline = make_pipeline(witness, true);
  pipeline->start();
  pipeline->wait();
  EXPECT_EQ(witness.frames, kFrames);
  EXPECT_EQ(witness.path.size(), static_cast<std::size_t>(kFrames));
  EXPECT_GT(witness.tiles_since_begin, 0U);
  EXPECT_EQ(pipeline->status().tracked, static_cast<std::uint64_t>(kFrames));
}

TEST(Pipeline, TheSameFramesGiveTheSameMap) {
  Witness first_witness;
  Witness second_witness;
  const auto first = make_pipeline(first_witness, true);
  first->start();
  first->wait();
  const auto second = make_pipeline(second_witness, true);
  second->start();
  second->wait();
  const MapSnapshot a = first->integrator().snapshot();
  const MapSnapshot b = second->integrator().snapshot();
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (const auto& [index, tile] : a.tiles) {
    ASSERT_TRUE(b.tiles.contains(index));
    EXPECT_EQ(tile->cells, b.tiles.at(index)->cells);
  }
}

TEST(Pipeline, AResetBeginsAnotherEpochBeforeAnythingOfItIsTold) {
  Witness witness;
  const auto pipeline = make_pipeline(witness, false);
  pipeline->start();
  witness.wait_until([&] { return witness.frames == kFrames; });
  while (pipeline->control().state() != SessionState::finished) std::this_thread::yield();
  ASSERT_EQ(pipeline->control().reset().outcome, ControlOutcome::done);
  witness.wait_until([&] { return witness.frames == 2 * kFrames; });
  pipeline->stop();
  pipeline->wait();
  ASSERT_EQ(witness.begins.size(), 2U);
  EXPECT_NE(witness.begins[0].epoch, witness.begins[1].epoch);
  EXPECT_EQ(witness.begins[0].epoch.size(), 16U);
  EXPECT_EQ(witness.begins[1].revision, 0U);
  EXPECT_EQ(witness.poses_since_begin, static_cast<std::size_t>(kFrames));
}

TEST(Pipeline, AFinishedSessionHasAllOfItsMap) {
  Witness all;
  const auto batch = make_pipeline(all, true);
  batch->start();
  batch->wait();
  Witness witness;
  const auto pipeline = make_pipeline(witness, false);
  pipeline->start();
  while (pipeline->control().state() != SessionState::finished) std::this_thread::yield();
  {
    const std::scoped_lock lock(witness.mutex);
    EXPECT_EQ(witness.frames, kFrames);
    EXPECT_EQ(witness.status.frames, static_cast<std::uint64_t>(kFrames));
    EXPECT_EQ(witness.tiles_since_begin, all.tiles_since_begin);
  }
  pipeline->stop();
  pipeline->wait();
}

TEST(Pipeline, WhatAStageThrowsComesOutOfWait) {
  Witness witness;
  const auto pipeline = make_pipeline(witness, true, 3);
  pipeline->start();
  EXPECT_THROW(pipeline->wait(), std::runtime_error);
  EXPECT_EQ(pipeline->control().state(), SessionState::failed);
  EXPECT_EQ(pipeline->control().reason(), "the cable is out");
}

TEST(Pipeline, ACameraThatIsGoneIsSaidWhileItIsWaitedFor) {
  Witness witness;
  auto source = std::make_unique<UnpluggedSource>(open_source({.spec = "sim:room"}));
  FrontEnd front_end(FrontEndOptions{}, Rectifier(*source->calibration()), std::nullopt, std::nullopt);
  MapIntegrator integrator(FlogOptions{}, front_end.camera(), front_end.max_disparity_px());
  Pipeline pipeline({}, std::move(source), std::move(front_end), std::move(integrator), witness);
  pipeline.start();
  witness.wait_until([&] { return !witness.status.warnings.empty(); });
  {
    const std::scoped_lock lock(witness.mutex);
    EXPECT_EQ(witness.status.warnings.front(), "camera B was unplugged");
  }
  pipeline.stop();
  pipeline.wait();
}

TEST(Pipeline, StoppingEndsAPausedSession) {
  Witness witness;
  const auto pipeline = make_pipeline(witness, false);
  pipeline->start();
  witness.wait_until([&] { return witness.frames >= 1; });
  pipeline->control().pause();
  pipeline->stop();
  pipeline->wait();
  EXPECT_EQ(pipeline->control().state(), SessionState::draining);
}

}  // namespace
}  // namespace flogmap
