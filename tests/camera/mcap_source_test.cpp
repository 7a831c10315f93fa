// Recordings of ROS 2 and Foxglove: whatever their layout and dialect, the frames are those of the same walk
// in a EuRoC folder.
#include "camera/mcap_source.hpp"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "tests/camera/mcap_recording.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

void expect_same_frames(StereoSource& source, StereoSource& expected) {
  while (const auto frame = expected.next()) {
    const auto same = source.next();
    ASSERT_TRUE(same);
    EXPECT_EQ(same->timestamp_ns, frame->timestamp_ns);
    EXPECT_EQ(same->left, frame->left);
    EXPECT_EQ(same->right, frame->right);
  }
  EXPECT_FALSE(source.next());
  EXPECT_EQ(source.skipped().count, 0) << source.skipped().last_reason;
}

void expect_same_camera(const CameraIntrinsics& camera, const CameraIntrinsics& expected) {
  EXPECT_EQ(camera.width_px, expected.width_px);
  EXPECT_EQ(camera.height_px, expected.height_px);
  EXPECT_EQ(camera.fx_px, expected.fx_px);
  EXPECT_EQ(camera.fy_px, expected.fy_px);
  EXPECT_EQ(camera.cx_px, expected.cx_px);
  EXPECT_EQ(camera.cy_px, expected.cy_px);
}

void expect_same_recording(StereoSource& source, StereoSource& expected) {
  EXPECT_EQ(source.info().num_frames, expected.info().num_frames);
  EXPECT_EQ(source.info().first_timestamp_ns, expected.info().first_timestamp_ns);
  EXPECT_EQ(source.info().last_timestamp_ns, expected.info().last_timestamp_ns);
  EXPECT_EQ(source.info().assumed, "");
  ASSERT_TRUE(source.calibration());
  const StereoCalibration calibration = *source.calibration(), other = *expected.calibration();
  EXPECT_TRUE(calibration.right_from_left.isApprox(other.right_from_left, 1e-12));
  expect_same_camera(calibration.left, other.left);
  expect_same_camera(calibration.right, other.right);
  expect_same_frames(source, expected);
}

TEST_F(McapRecordings, EveryLayoutGivesTheFramesOfTheEurocFolder) {
  for (const McapLayout& layout : all_layouts()) {
    SCOPED_TRACE(name_of(layout));
    expect_same_recording(*open_file(five_pairs(layout).finish()), *open());
  }
}

TEST_F(McapRecordings, EveryDialectGivesTheFramesOfTheEurocFolder) {
  for (const Dialect dialect : {Dialect::cdr_little, Dialect::cdr_big, Dialect::ros1, Dialect::foxglove}) {
    SCOPED_TRACE(schema_name(dialect, "Image"));
    expect_same_recording(*open_file(five_pairs({}, dialect).finish()), *open());
  }
}

TEST_F(McapRecordings, SeekFindsTheFirstFrameAtOrAfterATime) {
  for (const McapLayout& layout : all_layouts()) {
    SCOPED_TRACE(name_of(layout));
    const auto source = open_file(five_pairs(layout).finish());
    for (const int i : {4, 0, 2, 3, 1}) {
      for (const std::int64_t before : {std::int64_t{0}, std::int64_t{1}, kPeriod - 1}) {
        ASSERT_TRUE(source->seek(time_of(i) - before));
        const auto frame = source->next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->timestamp_ns, time_of(i));
        EXPECT_EQ(frame->right, grey_picture(10 * i + 1));
      }
    }
    ASSERT_TRUE(source->seek(time_of(4) + 1));
    EXPECT_FALSE(source->next());
    ASSERT_TRUE(source->seek(0));
    EXPECT_THAT(times(*source), ElementsAre(0, 1, 2, 3, 4));
    EXPECT_EQ(source->skipped().count, 0) << source->skipped().last_reason;
  }
}

TEST_F(McapRecordings, ALoopBeginsAgainUntilStopped) {
  const auto source = open_source({.spec = spec_of(five_pairs({}).finish()), .loop = true});
  for (int i = 0; i < 13; ++i) EXPECT_EQ(source->next()->timestamp_ns, time_of(i % 5));
  source->stop();
  EXPECT_FALSE(source->next());
}

TEST_F(McapRecordings, MessagesOutOfOrderComeInOrder) {
  std::mt19937 random(20261123);
  for (int round = 0; round < 30; ++round) {
    McapWriter out = writer({.messages_per_chunk = 3});
    std::vector<std::pair<double, std::pair<int, int>>> order;  // place in the file; side and frame
    for (int i = 0; i < 20; ++i)
      for (const int side : {1, 2})
        order.push_back({i + 2.5 * static_cast<double>(random()) / 4294967295.0, {side, i}});
    std::sort(order.begin(), order.end());
    std::int64_t log_time = kStart;
    for (const auto& [place, message] : order) {
      const auto [side, i] = message;
      out.add_message(side, log_time += 1'000'000, picture_message({}, 10 * i + side - 1, time_of(i)));
    }
    const auto source = open_file(out.finish());
    for (int i = 0; i < 20; ++i) {
      const auto frame = source->next();
      ASSERT_TRUE(frame) << i;
      EXPECT_EQ(frame->timestamp_ns, time_of(i));
      EXPECT_EQ(frame->left, grey_picture(10 * i));
      EXPECT_EQ(frame->right, grey_picture(10 * i + 1));
    }
    EXPECT_EQ(source->skipped().count, 0) << source->skipped().last_reason;
  }
}

TEST_F(McapRecordings, RecordersMayFillAChunkForEachCamera) {
  McapWriter out = writer({.messages_per_chunk = 8});
  out.end_chunk();
  for (const int first : {0, 8}) {
    for (const int side : {1, 2}) {
      for (int i = first; i < first + 8; ++i)
        out.add_message(side, time_of(i) + side, picture_message({}, 10 * i + side - 1, time_of(i)));
    }
  }
  const auto source = open_file(out.finish());
  std::vector<std::int64_t> expected(16);
  for (int i = 0; i < 16; ++i) expected[i] = i;
  EXPECT_EQ(times(*source), expected);
  EXPECT_EQ(source->skipped().count, 0) << source->skipped().last_reason;
  ASSERT_TRUE(source->seek(time_of(7)));
  EXPECT_EQ(source->next()->timestamp_ns, time_of(7));
}

TEST_F(McapRecordings, WhatHasNoPartnerIsSkippedAndNamedOnce) {
  McapWriter out = writer({});
  for (int i = 0; i < 8; ++i) {
    if (i != 2) out.add_message(1, time_of(i), picture_message({}, i, time_of(i)));
    if (i < 5) out.add_message(2, time_of(i), picture_message({}, i, time_of(i)));
  }
  const auto source = open_file(out.finish());
  EXPECT_EQ(source->skipped().count, 0);
  EXPECT_THAT(times(*source), ElementsAre(0, 1, 3, 4));
  EXPECT_EQ(source->skipped().count, 4);
  EXPECT_THAT(source->skipped().last_reason,
              HasSubstr("/stereo/left/image_raw at 1700000000.350000000 s: no right picture"));
  source->seek(0);
  EXPECT_THAT(times(*source), ElementsAre(0, 1, 3, 4));
  EXPECT_EQ(source->skipped().count, 4);
}

TEST_F(McapRecordings, PicturesArePairedWithTheNearestWithinTheSkewAllowed) {
  McapWriter out = writer({});
  const std::vector<int> late_ms{0, 4, -4, 6, 1};
  for (int i = 0; i < 5; ++i) {
    out.add_message(1, time_of(i), picture_message({}, i, time_of(i)));
    out.add_message(2, time_of(i), picture_message({}, i, time_of(i) + late_ms[i] * 1'000'000));
  }
  out.add_message(2, time_of(4), picture_message({}, 99, time_of(4) - 3'000'000));
  const std::string file = out.finish();
  const auto source = open_file(file);
  EXPECT_THAT(times(*source), ElementsAre(0, 1, 2, 4));
  EXPECT_EQ(source->skipped().count, 3);
  EXPECT_EQ(source->skew()->histogram.total(), 4);
  EXPECT_NEAR(source->skew()->histogram.largest_ms, 4, 1e-9);
  const auto generous = open_source({.spec = spec_of(file), .max_skew_ms = 7});
  EXPECT_THAT(times(*generous), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(generous->skipped().count, 1);
}

TEST_F(McapRecordings, PicturesWithoutAStampCountAsTakenWhenTheyWereRecorded) {
  McapWriter out = writer({});
  for (int i = 0; i < 3; ++i)
    for (const int side : {1, 2}) out.add_message(side, time_of(i) + side, picture_message({}, i, 0));
  const auto source = open_file(out.finish());
  EXPECT_THAT(times(*source), ElementsAre(0, 1, 2));
  EXPECT_THAT(source->info().assumed, HasSubstr("without a stamp"));
}

TEST_F(McapRecordings, WhatElseLiesInAFileIsPassedOver) {
  McapWriter out = writer({});
  const auto scan = out.add_channel("/scan", "sensor_msgs/msg/LaserScan", "cdr");
  const auto log = out.add_channel("/log", "", "json");
  for (int i = 0; i < 5; ++i) {
    out.add_message(scan, time_of(i), "not for us");
    out.add_record(9, std::string(5000, 'a'));   // an attachment
    out.add_record(12, std::string(30, 'm'));    // metadata
    out.add_record(200, std::string(300, 'x'));  // of an application
    add_pair(out, i);
    out.add_message(log, time_of(i), "{}");
  }
  for (const std::string& file : {out.finish(), out.unfinished()})
    expect_same_frames(*open_file(file), *open());
}

}  // namespace
}  // namespace flogmap
