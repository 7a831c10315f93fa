// Recordings as people have them: complete, damaged, out of order. Nothing crashes, everything lost is
// counted.
#include <gmock/gmock.h>

#include <cmath>
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

TEST_F(Recordings, KittiWithoutTimesIsTakenAtARateAndThatIsSaid) {
  folder_.write("k/calib.txt", "P0: 20 0 15.5 0 0 20 11.5 0 0 0 1 0\nP1: 20 0 15.5 -4 0 20 11.5 0 0 0 1 0\n");
  for (const char* camera : {"image_0", "image_1"}) {
    fs::create_directories(folder_.path() / "k" / camera);
    for (const int i : {0, 1, 3}) {  // 2 is missing: the others keep their times
      ASSERT_TRUE(write_picture(folder_.path() / "k" / camera / ("00000" + std::to_string(i) + ".png"),
                                grey_picture(i)));
    }
  }
  const std::string spec = "kitti:" + (folder_.path() / "k").string();
  for (const double rate_hz : {10.0, 5.0}) {
    const auto source = open_source({.spec = spec, .frame_rate_hz = rate_hz});
    EXPECT_THAT(source->info().assumed, HasSubstr(rate_hz == 10 ? "10 Hz" : "5 Hz"));
    for (const int i : {0, 1, 3}) EXPECT_EQ(source->next()->timestamp_ns, std::llround(i * 1e9 / rate_hz));
  }
  folder_.write("k/times.txt", "0\n0.1\n0.25\n0.3\n");
  const auto timed = open_source({.spec = spec});
  EXPECT_EQ(timed->info().assumed, "");
  for (const std::int64_t time_ms : {0, 100, 300})
    EXPECT_EQ(timed->next()->timestamp_ns, time_ms * 1'000'000);
  folder_.write("k/times.txt", "0\nsoon\n");
  EXPECT_THAT([&] { (void)open_source({.spec = spec}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("times.txt:2: must be seconds")));
}

/// A drive as KITTI's raw data come: pictures, times and inertial fixes below, calibrations above.
class KittiDrive : public Recordings {
 protected:
  static constexpr double kRoll = 0.05, kPitch = -0.1;

  void SetUp() override {
    // The camera looks forward: its x is the vehicle's right, its y down, its z forward.
    folder_.write("day/calib_imu_to_velo.txt",
                  "calib_time: 25-May-2012\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
    folder_.write("day/calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 0\n");
    folder_.write("day/calib_cam_to_cam.txt", cameras());
    folder_.write("day/drive/oxts/data/0000000000.txt",
                  "49.0 8.4 112.8 " + std::to_string(kRoll) + " " + std::to_string(kPitch) + " 2.1 1 2 3\n");
    for (const char* camera : {"image_00", "image_01", "image_02", "image_03"}) {
      const fs::path base = fs::path("day/drive") / camera;
      fs::create_directories(folder_.path() / base / "data");
      std::string times;
      for (int i = 0; i < 3; ++i) {
        times += "2011-09-26 13:02:2" + std::to_string(i) + ".594360375\n";
        ASSERT_TRUE(write_picture(folder_.path() / base / "data" / ("000000000" + std::to_string(i) + ".png"),
                                  grey_picture(10 * i + (camera[7] - '0'))));
      }
      folder_.write(base / "timestamps.txt", times);
    }
  }
  static std::string cameras() {
    std::string text = "calib_time: 09-Jan-2012\ncorner_dist: 9.95e-02\nR_rect_00: 1 0 0 0 1 0 0 0 1\n";
    for (int i = 0; i < 4; ++i) {
      const std::string n = "0" + std::to_string(i);
      text += "S_rect_" + n + ": 32 24\nP_rect_" + n + ": 20 0 15.5 " + std::to_string(-4 * i) +
              " 0 20 11.5 0 0 0 1 0\n";
    }
    return text;
  }
  std::unique_ptr<StereoSource> open_drive() {
    return open_source({.spec = "kitti:" + (folder_.path() / "day/drive").string()});
  }
};

TEST_F(KittiDrive, ComesWithItsTimesItsCalibrationAndUp) {
  const auto source = open_drive();
  EXPECT_EQ(source->info().assumed, "");
  for (int i = 0; i < 3; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    // date -u -d '2011-09-26 13:02:20' +%s
    EXPECT_EQ(frame->timestamp_ns, (1'317'042'140 + i) * std::int64_t{1'000'000'000} + 594'360'375);
    EXPECT_EQ(frame->left, grey_picture(10 * i));
    EXPECT_EQ(frame->right, grey_picture(10 * i + 1));
  }
  EXPECT_NEAR(source->calibration()->right_from_left.translation().x(), -0.2, 1e-12);
  ASSERT_TRUE(source->up_in_left_camera());
  // Nose down by 0.1 (its pitch is positive nose-down, about y to the left), right side down by 0.05.
  const Eigen::Vector3d up = *source->up_in_left_camera();
  EXPECT_NEAR(up.norm(), 1, 1e-12);
  EXPECT_NEAR(up.z(), -std::sin(kPitch), 1e-6);                    // forward
  EXPECT_NEAR(up.x(), -std::sin(kRoll) * std::cos(kPitch), 1e-6);  // right
  EXPECT_NEAR(up.y(), -std::cos(kRoll) * std::cos(kPitch), 1e-6);  // down
}

TEST_F(KittiDrive, TheColourPairIsTakenWhereThereIsNoGreyOne) {
  fs::remove_all(folder_.path() / "day/drive/image_00");
  const auto source = open_drive();
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->left, grey_picture(2));
  EXPECT_EQ(frame->right, grey_picture(3));
}

TEST_F(KittiDrive, WithoutFixesThereIsNoUpAndDamageIsNamed) {
  folder_.write("day/drive/oxts/data/0000000000.txt", "49.0 8.4 nowhere\n");
  EXPECT_THAT([&] { (void)open_drive(); }, ThrowsMessage<std::runtime_error>(HasSubstr("0000000000.txt")));
  folder_.write("day/drive/oxts/data/0000000000.txt", "49.0 8.4 112.8 0 0 0\n");
  folder_.write("day/calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 5\nT: 0 0 0\n");
  EXPECT_THAT([&] { (void)open_drive(); }, ThrowsMessage<std::runtime_error>(HasSubstr("no rotation")));
  fs::remove_all(folder_.path() / "day/drive/oxts");
  EXPECT_FALSE(open_drive()->up_in_left_camera());
  folder_.write("day/drive/image_00/timestamps.txt", "2011-09-26 13:62:20.5\n");
  EXPECT_THAT([&] { (void)open_drive(); }, ThrowsMessage<std::runtime_error>(HasSubstr("timestamps.txt:1")));
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
