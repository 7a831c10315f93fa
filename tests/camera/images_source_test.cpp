// Pictures named by two patterns: paired by their numbers, whatever else lies there.
#include <fstream>

#include "tests/camera/recording_folder.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using testing::grey_picture;
using ::testing::HasSubstr;
using testing::Recordings;
using ::testing::ThrowsMessage;

TEST_F(Recordings, GlobsArePairedByTheirNumbers) {
  const std::string calibration = folder_
                                      .write("calib.txt",
                                             "P0: 20 0 15.5 0 0 20 11.5 0 0 0 1 0\n"
                                             "P1: 20 0 15.5 -4 0 20 11.5 0 0 0 1 0\n")
                                      .string();
  for (const int i : {2, 10, 9, 3}) {
    ASSERT_TRUE(write_picture(folder_.path() / ("left" + std::to_string(i) + ".png"), grey_picture(i)));
    if (i == 9) continue;
    ASSERT_TRUE(write_picture(folder_.path() / ("right" + std::to_string(i) + ".png"), grey_picture(i)));
  }
  const std::string spec =
      "images:" + (folder_.path() / "left*.png").string() + "," + (folder_.path() / "right*.png").string();
  EXPECT_THAT([&] { static_cast<void>(open_source({.spec = spec})); },
              ThrowsMessage<std::runtime_error>(HasSubstr("--calibration")));
  const auto source = open_source({.spec = spec, .calibration_file = calibration});
  for (const int i : {2, 3, 10}) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->left, grey_picture(i));
    EXPECT_EQ(frame->right, grey_picture(i));
  }
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->skipped().count, 1);
  EXPECT_THROW(static_cast<void>(
                   open_source({.spec = "images:/nowhere/*,/nowhere/*", .calibration_file = calibration})),
               std::runtime_error);
}

class Photos : public Recordings {
 protected:
  std::string calibration_ = folder_
                                 .write("calib.txt",
                                        "P0: 20 0 15.5 0 0 20 11.5 0 0 0 1 0\n"
                                        "P1: 20 0 15.5 -4 0 20 11.5 0 0 0 1 0\n")
                                 .string();

  void SetUp() override {}
  void take(const std::string& name, int tone) {
    ASSERT_TRUE(write_picture(folder_.path() / (name + ".png"), grey_picture(tone)));
  }
  std::unique_ptr<StereoSource> open_photos(const std::string& left = "l*", const std::string& right = "r*") {
    return open_source(
        {.spec = "images:" + (folder_.path() / left).string() + "," + (folder_.path() / right).string(),
         .calibration_file = calibration_});
  }
  /// Tones of the left pictures; those on the right must be one brighter.
  static std::vector<int> shown(StereoSource& source) {
    std::vector<int> result;
    std::int64_t last_ns = -1;
    while (auto frame = source.next()) {
      EXPECT_EQ(frame->right.bytes[0], frame->left.bytes[0] + 1);
      EXPECT_GT(frame->timestamp_ns, last_ns);
      last_ns = frame->timestamp_ns;
      result.push_back(frame->left.bytes[0]);
    }
    return result;
  }
};

TEST_F(Photos, NamesThatAreTimesGiveTheTimes) {
  for (int i = 0; i < 3; ++i) {
    take("l" + testing::stamp(i), 10 * i);
    take("r" + testing::stamp(i), 10 * i + 1);
  }
  const auto source = open_photos();
  EXPECT_EQ(source->info().assumed, "");
  EXPECT_EQ(source->info().first_timestamp_ns, testing::kStart);
  EXPECT_EQ(source->info().last_timestamp_ns, testing::kStart + 2 * testing::kPeriod);
  ASSERT_TRUE(source->seek(testing::kStart + 1));
  EXPECT_THAT(shown(*source), ::testing::ElementsAre(10, 20));
}

TEST_F(Photos, WithoutNumbersTheyAreTakenInOrderAndDifferentCountsAreSaid) {
  for (const char* name : {"a", "b", "c"}) take(std::string("l-") + name, 10 * (name[0] - 'a'));
  for (const char* name : {"a", "b"}) take(std::string("r-") + name, 10 * (name[0] - 'a') + 1);
  const auto source = open_photos();
  EXPECT_THAT(source->info().assumed, HasSubstr("3 left and 2 right"));
  EXPECT_THAT(shown(*source), ::testing::ElementsAre(0, 10));
  EXPECT_EQ(source->skipped().count, 1);
}

TEST_F(Photos, AnythingElseThatMatchesIsSkippedAndNamed) {
  for (int i = 0; i < 6; ++i) {
    take("l" + std::to_string(i), 10 * i);
    take("r" + std::to_string(i), 10 * i + 1);
  }
  fs::remove(folder_.path() / "l1.png");
  fs::create_directory(folder_.path() / "l1.png");
  fs::resize_file(folder_.path() / "r2.png", 40);
  folder_.write("l3.png", std::string("\x89PNG\r\n\x1a\n", 8) + std::string(300, '\xff') + "IEND");
  fs::remove(folder_.path() / "r4.png");
  fs::create_symlink("nowhere", folder_.path() / "r4.png");
  const auto source = open_photos();
  EXPECT_THAT(shown(*source), ::testing::ElementsAre(0, 50));
  EXPECT_EQ(source->skipped().count, 4);
}

TEST_F(Photos, NumbersBeyondAllBoundsAreNames) {
  const std::string huge(40, '9');
  for (const char* end : {"1", "2"}) {
    take("l" + huge + end, 10 * (end[0] - '0'));
    take("r" + huge + end, 10 * (end[0] - '0') + 1);
  }
  EXPECT_THAT(shown(*open_photos()), ::testing::ElementsAre(10, 20));
}

TEST_F(Photos, WhatCannotBeReadAtAllIsRefusedInOneLine) {
  const auto refused = [&](const std::string& left, const std::string& right, const std::string& why) {
    EXPECT_THAT([&] { (void)open_photos(left, right); }, ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  };
  take("l1", 0);
  take("r2", 1);
  refused("l*", "none*", "matches no picture");
  refused("l*", "r*", "no stereo pair");
  folder_.write("r1.png", "not a picture");
  refused("l*", "r*", "no readable pair");
  ASSERT_TRUE(write_picture(folder_.path() / "r1.png", grey_picture(1, 16, 12)));
  refused("l*", "r*", "one size");
}

}  // namespace
}  // namespace flogmap
