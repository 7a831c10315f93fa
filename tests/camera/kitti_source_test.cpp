// KITTI as it comes: odometry sequences and raw drives, complete and damaged.
#include <cmath>
#include <fstream>

#include "tests/camera/recording_folder.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using testing::grey_picture;
using ::testing::HasSubstr;
using testing::Recordings;
using ::testing::ThrowsMessage;

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

/// A sequence of five pairs in the odometry layout.
class KittiSequence : public Recordings {
 protected:
  void SetUp() override {
    folder_.write("k/calib.txt",
                  "P0: 20 0 15.5 0 0 20 11.5 0 0 0 1 0\nP1: 20 0 15.5 -4 0 20 11.5 0 0 0 1 0\n");
    folder_.write("k/times.txt", "0\n0.1\n0.2\n0.3\n0.4\n");
    for (const int camera : {0, 1}) {
      fs::create_directories(file(camera, 0).parent_path());
      for (int i = 0; i < 5; ++i) ASSERT_TRUE(write_picture(file(camera, i), grey_picture(10 * i + camera)));
    }
  }
  fs::path file(int camera, int i) {
    return folder_.path() / "k" / ("image_" + std::to_string(camera)) /
           ("00000" + std::to_string(i) + ".png");
  }
  std::unique_ptr<StereoSource> open_sequence() {
    return open_source({.spec = "kitti:" + (folder_.path() / "k").string()});
  }
  /// Tenths of a second of all frames; each must show what was taken then.
  static std::vector<std::int64_t> shown(StereoSource& source) {
    std::vector<std::int64_t> result;
    while (auto frame = source.next()) {
      const std::int64_t i = frame->timestamp_ns / 100'000'000;
      EXPECT_EQ(frame->left, grey_picture(static_cast<int>(10 * i)));
      EXPECT_EQ(frame->right, grey_picture(static_cast<int>(10 * i + 1)));
      result.push_back(i);
    }
    return result;
  }
};

TEST_F(KittiSequence, SeekFindsTheFirstFrameAtOrAfterATime) {
  const auto source = open_sequence();
  ASSERT_TRUE(source->seek(150'000'000));
  EXPECT_THAT(shown(*source), ::testing::ElementsAre(2, 3, 4));
}

TEST_F(KittiSequence, TruncatedAndMissingPicturesCostTheirPairsOnly) {
  fs::resize_file(file(0, 1), fs::file_size(file(0, 1)) / 2);
  fs::resize_file(file(1, 3), 0);
  fs::remove(file(0, 4));
  const auto source = open_sequence();
  EXPECT_THAT(shown(*source), ::testing::ElementsAre(0, 2));
  EXPECT_EQ(source->skipped().count, 3);
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("000003.png"));
}

TEST_F(KittiSequence, DifferentCountsLeftAndRightAreSaid) {
  for (const int i : {3, 4}) fs::remove(file(1, i));
  const auto source = open_sequence();
  EXPECT_THAT(shown(*source), ::testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(source->skipped().count, 2);
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("no right picture"));
}

TEST_F(KittiSequence, TimesThatStepBackAreSkipped) {
  folder_.write("k/times.txt", "0\n0.2\n0.1\n0.3\n0.3\n");
  const auto source = open_sequence();
  std::vector<std::int64_t> times_ms;
  while (auto frame = source->next()) times_ms.push_back(frame->timestamp_ns / 1'000'000);
  EXPECT_THAT(times_ms, ::testing::ElementsAre(0, 200, 300));
  EXPECT_EQ(source->skipped().count, 2);
  EXPECT_THAT(source->skipped().last_reason, HasSubstr("time does not increase"));
}

TEST_F(KittiSequence, DamagedCalibrationsAreRefusedInOneLine) {
  for (const char* text : {"", "P0: 20 0 15.5\n", "P0: 20 0 15.5 0 0 20 11.5 0 0 0 1 0\n",
                           "\x7f"
                           "ELF\1\2\3",
                           "P0: nan 0 15.5 0 0 20 11.5 0 0 0 1 0\nP1: 20 0 15.5 -4 0 20 11.5 0 0 0 1 0\n"}) {
    folder_.write("k/calib.txt", text);
    EXPECT_THAT([&] { (void)open_sequence(); }, ThrowsMessage<std::runtime_error>(HasSubstr("calib.txt")))
        << text;
  }
}

}  // namespace
}  // namespace flogmap
