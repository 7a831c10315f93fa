// Recordings as people have them: complete, damaged, out of order. Nothing crashes, everything lost is
// counted.
#include <fstream>

#include "tests/camera/recording_folder.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using testing::grey_picture;
using ::testing::HasSubstr;
using testing::kPeriod;
using testing::kStart;
using testing::Recordings;
using testing::sensor_yaml;
using testing::stamp;
using ::testing::ThrowsMessage;

TEST_F(Recordings, EveryPairComesInOrderWithItsPictures) {
  const auto source = open();
  EXPECT_EQ(source->info().num_frames, 5);
  EXPECT_EQ(source->info().last_timestamp_ns, kStart + 4 * kPeriod);
  for (int i = 0; i < 5; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->timestamp_ns, kStart + i * kPeriod);
    EXPECT_EQ(frame->left, grey_picture(10 * i));
    EXPECT_EQ(frame->right, grey_picture(10 * i + 1));
  }
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->skipped().count, 0);
  EXPECT_NEAR(source->calibration()->right_from_left.translation().x(), -0.1, 1e-12);
}

TEST_F(Recordings, SeekFindsTheFirstFrameAtOrAfterATime) {
  const auto source = open();
  for (const auto& [offset, expected] : {std::pair(0, 0), {1, 1}, {50'000'000, 1}, {120'000'000, 3}}) {
    EXPECT_TRUE(source->seek(kStart + offset));
    EXPECT_EQ(source->next()->timestamp_ns, kStart + expected * kPeriod);
  }
  EXPECT_TRUE(source->seek(kStart + 1'000'000'000));
  EXPECT_FALSE(source->next());
}

TEST_F(Recordings, ALoopBeginsAgainUntilStopped) {
  const auto source = open(true);
  for (int i = 0; i < 13; ++i) EXPECT_EQ(source->next()->timestamp_ns, kStart + i % 5 * kPeriod);
  source->stop();
  EXPECT_FALSE(source->next());
}

TEST_F(Recordings, AMissingPartnerIsSkippedAndNamed) {
  fs::remove(picture("cam1", 2));
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 1, 3, 4));
  EXPECT_EQ(source->skipped().count, 1);
  EXPECT_THAT(source->skipped().last_reason, HasSubstr(stamp(2) + ".png"));
}

TEST_F(Recordings, ARowWithoutPartnerIsSkippedAndNamed) {
  folder_.write("mav0/cam1/data.csv", "#t,f\n" + stamp(1) + "," + stamp(1) + ".png\n" + stamp(3) + "," +
                                          stamp(3) + ".png\n" + stamp(9) + "," + stamp(9) + ".png\n");
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(1, 3));
  EXPECT_EQ(source->skipped().count, 4);
}

TEST_F(Recordings, ATruncatedPictureIsSkippedAndNamed) {
  fs::resize_file(picture("cam0", 1), fs::file_size(picture("cam0", 1)) - 20);
  fs::resize_file(picture("cam1", 3), 0);
  std::ofstream(picture("cam0", 4), std::ios::trunc) << "not a picture at all";
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 2));
  EXPECT_EQ(source->skipped().count, 3);
  EXPECT_TRUE(source->seek(kStart + kPeriod));
  EXPECT_TRUE(source->next());
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("truncated PNG"));
}

TEST_F(Recordings, APictureOfAnotherSizeInTheMiddleIsSkippedAndNamed) {
  ASSERT_TRUE(write_picture(picture("cam1", 2), grey_picture(5, 16, 12)));
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("16x12"));
}

TEST_F(Recordings, RowsOutOfOrderAreSortedAndThoseOfOneTimeCountOnce) {
  const auto row = [](int i) { return stamp(i) + "," + stamp(i) + ".png\n"; };
  folder_.write("mav0/cam0/data.csv",
                row(0) + row(2) + row(1) + row(2) + row(3) + "oops,x.png\n" + stamp(4) + "\n");
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(source->skipped().count, 4);  // three rows of the left, then 4 of the right without partner
}

TEST_F(Recordings, WhatCannotBeReadAtAllIsRefusedInOneLine) {
  ASSERT_TRUE(write_picture(picture("cam1", 0), grey_picture(5, 16, 12)));
  expect_refused("one size");
  ASSERT_TRUE(write_picture(picture("cam1", 0), grey_picture(5)));
  folder_.write("mav0/cam1/sensor.yaml", sensor_yaml(0.1, "[64, 48]"));
  expect_refused("64x48");
  fs::remove(folder_.path() / "mav0/cam1/sensor.yaml");
  expect_refused("cam1/sensor.yaml");
  folder_.write("mav0/cam1/sensor.yaml", sensor_yaml(0.1));
  folder_.write("mav0/cam0/data.csv", "#timestamp [ns],filename\n");
  expect_refused("lists no pictures");
  folder_.write("mav0/cam0/data.csv", "99999999999999999999,x.png\n");
  expect_refused("time 99999999999999999999 is out of range");
  fs::remove(folder_.path() / "mav0/cam0/data.csv");
  expect_refused("data.csv");
  fs::remove_all(folder_.path() / "mav0/cam1");
  expect_refused("cam1");
  fs::remove_all(folder_.path() / "mav0");
  expect_refused("EuRoC layout");
  EXPECT_THROW(static_cast<void>(open_source({.spec = "euroc:/nowhere"})), std::runtime_error);
}

TEST_F(Recordings, ACalibrationFileOverridesTheFolders) {
  fs::remove(folder_.path() / "mav0/cam0/sensor.yaml");
  const std::string left = folder_.write("l.yaml", sensor_yaml(0)).string();
  const std::string right = folder_.write("r.yaml", sensor_yaml(0.25)).string();
  const auto source =
      open_source({.spec = "euroc:" + folder_.path().string(), .calibration_file = left + "," + right});
  EXPECT_NEAR(source->calibration()->right_from_left.translation().x(), -0.25, 1e-12);
}

TEST_F(Recordings, DifferentCountsLeftAndRightCostOnlyThoseWithoutPartner) {
  std::string csv;
  for (const int i : {0, 1, 3}) csv += stamp(i) + "," + stamp(i) + ".png\n";  // two fewer on the right
  folder_.write("mav0/cam1/data.csv", csv);
  const auto source = open();
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 1, 3));
  EXPECT_EQ(source->skipped().count, 2);
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("no right picture of that time"));
}

TEST_F(Recordings, RowsInAnyOrderNeverMakeTimesStepBack) {
  std::string csv;
  for (const int i : {4, 3, 2, 1, 0}) csv += stamp(i) + "," + stamp(i) + ".png\n";
  folder_.write("mav0/cam0/data.csv", csv);
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(source->skipped().count, 0);
  EXPECT_THAT(source->info().assumed, HasSubstr("sorted"));
}

TEST_F(Recordings, HostileListsCostTheirRowsAndNothingElse) {
  const std::string good = stamp(1) + "," + stamp(1) + ".png\n";
  for (const std::string& row :
       {std::string("9223372036854775808,x.png\n"), std::string("-1e300,x.png\n"), std::string(",\n"),
        std::string(100'000, ',') + "\n", std::string(1'000'000, '7') + "\n", std::string("\0\0\0,\0\n", 6),
        stamp(0) + ",../../../../../../../dev/zero\n", stamp(0) + ",.\n",
        stamp(0) + "," + std::string(5000, 'a') + "\n"}) {
    folder_.write("mav0/cam0/data.csv", row + good);
    const auto source = open();
    EXPECT_THAT(times(*source), ::testing::ElementsAre(1)) << row.substr(0, 60);
    EXPECT_GT(source->skipped().count, 0);
  }
}

TEST_F(Recordings, APictureThatClaimsToBeHugeIsSkipped) {
  // A PGM of 60,000 x 60,000 in a file of 30 bytes; a PNG whose header says the same.
  std::ofstream(picture("cam0", 1), std::ios::trunc) << "P5\n60000 60000\n255\n0123456789";
  std::fstream png(picture("cam1", 3), std::ios::in | std::ios::out | std::ios::binary);
  png.seekp(16);
  png.write("\0\0\xEA\x60\0\0\xEA\x60", 8);
  png.close();
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 2, 4));
  EXPECT_EQ(source->skipped().count, 2);
}

}  // namespace
}  // namespace flogmap
