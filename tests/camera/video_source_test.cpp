// Two videos and one side by side give the same pairs.
#include "camera/video_source.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/videoio.hpp>
#include <random>
#include <stdexcept>

#include "camera/source_spec.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Videos : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  std::string calibration_ =
      folder_
          .write("calib.txt", "P0: 60 0 31.5 0 0 60 23.5 0 0 0 1 0\nP1: 60 0 31.5 -6 0 60 23.5 0 0 0 1 0\n")
          .string();

  std::string path(const std::string& name) { return (folder_.path() / name).string(); }

  /// Frame i is grey of tone 10 + 20 i, its right half (if side by side) five brighter.
  void write_video(const std::string& name, int count, int width, int extra) {
    cv::VideoWriter writer(path(name), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20, {width, 48});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < count; ++i) {
      cv::Mat frame(48, width, CV_8UC3, cv::Scalar::all(10 + 20 * i + extra));
      if (width == 128) frame.colRange(64, 128) += cv::Scalar::all(5);
      writer.write(frame);
    }
  }

  static void expect_frame(const std::optional<StereoFrame>& frame, int i) {
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->timestamp_ns, i * 50'000'000LL);
    EXPECT_EQ(frame->left.width, 64);
    EXPECT_EQ(frame->right.height, 48);
    EXPECT_NEAR(frame->left.bytes[64 * 24 * 3 + 30], 10 + 20 * i, 2);
    EXPECT_NEAR(frame->right.bytes[64 * 24 * 3 + 30], 15 + 20 * i, 2);
  }
};

TEST_F(Videos, TwoFilesAreReadInStepAndTheLongerEndIsCounted) {
  write_video("l.avi", 5, 64, 0);
  write_video("r.avi", 4, 64, 5);
  const auto source =
      open_source({.spec = "video:" + path("l.avi") + "," + path("r.avi"), .calibration_file = calibration_});
  EXPECT_EQ(source->calibration()->left.width_px, 64);
  for (int i = 0; i < 4; ++i) expect_frame(source->next(), i);
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->skipped().count, 1);
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("r.avi"));
}

TEST_F(Videos, OneFileHoldsBothPicturesSideBySide) {
  write_video("both.avi", 4, 128, 0);
  const auto source =
      open_source({.spec = "sbs:" + path("both.avi"), .calibration_file = calibration_, .loop = true});
  for (int i = 0; i < 6; ++i) expect_frame(source->next(), i % 4);
  ASSERT_TRUE(source->seek(90'000'000));
  expect_frame(source->next(), 2);
  source->stop();
  EXPECT_FALSE(source->next());
}

TEST_F(Videos, WhatCannotBeReadIsRefusedInWords) {
  write_video("l.avi", 2, 64, 0);
  write_video("wide.avi", 2, 128, 0);
  folder_.write("text.avi", "no video");
  const auto refused = [&](const std::string& spec, const std::string& calibration, const std::string& why) {
    EXPECT_THAT([&] { static_cast<void>(open_source({.spec = spec, .calibration_file = calibration})); },
                ThrowsMessage<std::runtime_error>(HasSubstr(why)))
        << spec;
  };
  refused("video:" + path("l.avi") + "," + path("wide.avi"), calibration_, "one size");
  refused("video:" + path("l.avi"), calibration_, "LEFT,RIGHT");
  refused("video:" + path("l.avi") + "," + path("none.avi"), calibration_, "none.avi");
  refused("sbs:" + path("text.avi"), calibration_, "text.avi");
  refused("sbs:" + path("wide.avi"), "", "--calibration");
}

TEST_F(Videos, TwoFilesCanBeSoughtAndLooped) {
  write_video("l.avi", 4, 64, 0);
  write_video("r.avi", 4, 64, 5);
  const auto source = open_source({.spec = "video:" + path("l.avi") + "," + path("r.avi"),
                                   .calibration_file = calibration_,
                                   .loop = true});
  for (int i = 0; i < 6; ++i) expect_frame(source->next(), i % 4);
  for (const int i : {3, 0, 2}) {
    ASSERT_TRUE(source->seek(i * 50'000'000LL));
    expect_frame(source->next(), i);
  }
}

TEST_F(Videos, AFileCutOffInTheMiddleGivesItsBeginning) {
  write_video("l.avi", 10, 64, 0);
  write_video("r.avi", 10, 64, 5);
  std::filesystem::resize_file(path("r.avi"), std::filesystem::file_size(path("r.avi")) * 8 / 10);
  const auto source =
      open_source({.spec = "video:" + path("l.avi") + "," + path("r.avi"), .calibration_file = calibration_});
  int count = 0;
  while (auto frame = source->next()) expect_frame(frame, count++);
  EXPECT_GT(count, 2);
  EXPECT_LT(count, 10);
  EXPECT_EQ(source->skipped().count, 1);
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("r.avi"));
}

TEST_F(Videos, DamagedFilesNeverCrash) {
  write_video("good.avi", 4, 128, 0);
  std::ifstream in(path("good.avi"), std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(in), {}};
  std::mt19937 random(20261123);
  for (int round = 0; round < 40; ++round) {
    std::string bad = good;
    for (int i = 0; i < 20; ++i) bad[random() % bad.size()] = static_cast<char>(random());
    folder_.write("bad.avi", bad);
    try {
      const auto source = open_source({.spec = "sbs:" + path("bad.avi"), .calibration_file = calibration_});
      std::int64_t last_ns = -1;
      for (int i = 0; i < 20; ++i) {
        const auto frame = source->next();
        if (!frame) break;
        EXPECT_GT(frame->timestamp_ns, last_ns);
        last_ns = frame->timestamp_ns;
      }
    } catch (const std::runtime_error& refused) {
      EXPECT_THAT(refused.what(), HasSubstr("sbs:"));
    }
  }
}

}  // namespace
}  // namespace flogmap
