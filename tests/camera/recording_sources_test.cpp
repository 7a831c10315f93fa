// Recordings as people have them: complete, damaged, out of order. Nothing crashes, everything lost is
// counted.
#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <stdexcept>

#include "camera/inertial_up.hpp"
#include "camera/picture_files.hpp"
#include "camera/source_spec.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::int64_t kStart = 1'700'000'000'000'000'000, kPeriod = 50'000'000;

std::string sensor_yaml(double x_m, const std::string& resolution = "[32, 24]") {
  return "T_BS:\n  data: [1, 0, 0, " + std::to_string(x_m) +
         ", 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nresolution: " + resolution +
         "\ncamera_model: pinhole\nintrinsics: [20, 20, 15.5, 11.5]\ndistortion_model: radial-tangential\n"
         "distortion_coefficients: [0, 0, 0, 0]\n";
}

Picture grey_picture(int tone, int width = 32, int height = 24) {
  return {
      width, height, 1, 8,
      std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height, static_cast<std::uint8_t>(tone))};
}

std::string stamp(int i) { return std::to_string(kStart + i * kPeriod); }

class Recordings : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;

  void SetUp() override { write_euroc(5); }

  void write_euroc(int count) {
    for (const char* camera : {"cam0", "cam1"}) {
      const fs::path base = fs::path("mav0") / camera;
      std::string csv = "#timestamp [ns],filename\r\n";
      folder_.write(base / "sensor.yaml", sensor_yaml(camera[3] == '0' ? 0 : 0.1));
      fs::create_directories(folder_.path() / base / "data");
      for (int i = 0; i < count; ++i) {
        csv += stamp(i) + "," + stamp(i) + ".png\r\n";
        ASSERT_TRUE(write_picture(picture(camera, i), grey_picture(10 * i + (camera[3] - '0'))));
      }
      folder_.write(base / "data.csv", csv);
    }
  }
  fs::path picture(const std::string& camera, int i) {
    return folder_.path() / "mav0" / camera / "data" / (stamp(i) + ".png");
  }
  std::unique_ptr<StereoSource> open(bool loop = false) {
    return open_source({.spec = "euroc:" + folder_.path().string(), .loop = loop});
  }
  static std::vector<std::int64_t> times(StereoSource& source) {
    std::vector<std::int64_t> result;
    while (auto frame = source.next()) result.push_back((frame->timestamp_ns - kStart) / kPeriod);
    return result;
  }
  void expect_refused(const std::string& why) {
    EXPECT_THAT([&] { static_cast<void>(open()); }, ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  }
};

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

TEST_F(Recordings, TimesThatStepBackAreSkipped) {
  const auto row = [](int i) { return stamp(i) + "," + stamp(i) + ".png\n"; };
  folder_.write("mav0/cam0/data.csv",
                row(0) + row(2) + row(1) + row(2) + row(3) + "oops,x.png\n" + stamp(4) + "\n");
  const auto source = open();
  EXPECT_THAT(times(*source), ::testing::ElementsAre(0, 2, 3));
  EXPECT_EQ(source->skipped().count, 6);  // four rows of the left, then 1 and 4 of the right without partner
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

TEST_F(Recordings, KittiFoldersComeWithTheirTimes) {
  folder_.write("k/calib.txt", "P0: 20 0 15.5 0 0 20 11.5 0 0 0 1 0\nP1: 20 0 15.5 -4 0 20 11.5 0 0 0 1 0\n");
  folder_.write("k/times.txt", "0.0\n1.5e-01\n0.3\n0.3\n");
  for (const char* camera : {"image_0", "image_1"}) {
    fs::create_directories(folder_.path() / "k" / camera);
    for (int i = 0; i < 5; ++i) {
      if (camera[6] == '1' && i == 1) continue;
      ASSERT_TRUE(write_picture(folder_.path() / "k" / camera / ("00000" + std::to_string(i) + ".png"),
                                grey_picture(i)));
    }
  }
  const auto source = open_source({.spec = "kitti:" + (folder_.path() / "k").string()});
  EXPECT_EQ(source->calibration()->left.width_px, 32);  // from the pictures
  EXPECT_EQ(source->next()->timestamp_ns, 0);
  EXPECT_EQ(source->next()->timestamp_ns, 300'000'000);
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->skipped().count, 3);
  EXPECT_THROW(static_cast<void>(open_source({.spec = "kitti:" + folder_.path().string()})),
               std::runtime_error);
}

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

TEST(InertialUp, IsTheMeanOfTheRestingStart) {
  const Eigen::Vector3d gravity = 9.81 * Eigen::Vector3d(0.1, -0.99, 0.1).normalized();
  std::vector<Acceleration> samples;
  for (int i = 0; i < 400; ++i) {
    const double shake = i % 2 ? 0.8 : -0.8;
    const double start = i > 250 ? 3.0 : 0.0;  // the camera is taken up
    samples.push_back({i / 200.0, gravity + Eigen::Vector3d(shake, 0, start)});
  }
  const auto up = resting_acceleration(samples);
  ASSERT_TRUE(up);
  EXPECT_LT((up->normalized() - gravity.normalized()).norm(), 0.003);
}

TEST(InertialUp, SaysNothingWhenTheStartIsNoRest) {
  std::vector<Acceleration> moving, falling, brief;
  for (int i = 0; i < 400; ++i) {
    moving.push_back({i / 200.0, Eigen::Vector3d(0.02 * i, 9.81, 0)});
    falling.push_back({i / 200.0, Eigen::Vector3d(0, 2, 0)});
    if (i < 50) brief.push_back({i / 200.0, Eigen::Vector3d(0, 9.81, 0)});
  }
  EXPECT_FALSE(resting_acceleration(moving));
  EXPECT_FALSE(resting_acceleration(falling));
  EXPECT_FALSE(resting_acceleration(brief));
  EXPECT_FALSE(resting_acceleration({}));
}

}  // namespace
}  // namespace flogmap
