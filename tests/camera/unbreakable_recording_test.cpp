// A recording that is broken off, by a kill or by a full disk, is a shorter recording.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <random>
#include <thread>

#include "camera/recording_writer.hpp"
#include "camera/source_spec.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

StereoCalibration plain_pair(int width, int height) {
  StereoCalibration pair;
  pair.left = {width, height, 100, 100, width / 2.0, height / 2.0, Distortion::none, {}};
  pair.right = pair.left;
  pair.right_from_left.translation().x() = -0.1;
  pair.dialect = "test";
  return pair;
}

Picture noise(int width, int height, std::mt19937& random) {
  Picture picture{width, height, 1, 8, {}};
  picture.bytes.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::uint8_t& byte : picture.bytes) byte = static_cast<std::uint8_t>(random());
  return picture;
}

/// Reads everything back; every pair that is listed must be whole.
std::int64_t count_whole_pairs(const std::filesystem::path& folder) {
  const auto source = open_source({.spec = "euroc:" + folder.string()});
  std::int64_t count = 0;
  while (const auto frame = source->next()) ++count;
  EXPECT_EQ(count, source->info().num_frames);
  return count;
}

/// A process that writes pairs as fast as it can and says so after each, until it is killed.
void write_until_killed(const std::filesystem::path& folder, bool compress, int report) {
  std::mt19937 random(1);
  RecordingWriter writer(folder, plain_pair(160, 120), {.compress = compress});
  for (std::int64_t i = 0;; ++i) {
    writer.write({i * 1'000'000, noise(160, 120, random), noise(160, 120, random)});
    if (::write(report, "x", 1) != 1) ::_exit(1);
  }
}

TEST(UnbreakableRecording, NoFinishedPairIsLostByAKill) {
  std::mt19937 random(5);
  for (int round = 0; round < 10; ++round) {
    const testing::TemporaryFolder folder;
    int report[2];
    ASSERT_EQ(::pipe(report), 0);
    const pid_t writer = ::fork();
    if (writer == 0) write_until_killed(folder.path(), round % 2 == 0, report[1]);
    ::close(report[1]);
    const int wanted = 2 + static_cast<int>(random() % 20);
    std::int64_t finished = 0;
    char one = 0;
    while (finished < wanted && ::read(report[0], &one, 1) == 1) ++finished;
    std::this_thread::sleep_for(
        std::chrono::microseconds(random() % 3000));  // somewhere within the next pair
    ::kill(writer, SIGKILL);
    while (::read(report[0], &one, 1) == 1) ++finished;
    ::close(report[0]);
    ::waitpid(writer, nullptr, 0);
    EXPECT_GE(count_whole_pairs(folder.path()), finished);
  }
}

TEST(UnbreakableRecording, TwoCamerasAt60HzAreWrittenInTime) {
  // By the time that the processor works, which does not depend on what else the machine does.
  constexpr int kPairs = 60;
  constexpr double kRateHz = 60;
  const testing::TemporaryFolder folder;
  std::mt19937 random(3);
  const Picture left = noise(752, 480, random), right = noise(752, 480, random);
  RecordingWriter writer(folder.path(), plain_pair(752, 480), {.compress = false});
  const std::clock_t start = std::clock();
  for (std::int64_t i = 0; i < kPairs; ++i) writer.write({i * 16'666'667, left, right});
  const double busy_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("pairs_per_s", std::to_string(kPairs / busy_s));
  EXPECT_LT(busy_s, kPairs / kRateHz);
  EXPECT_EQ(count_whole_pairs(folder.path()), kPairs);
}

/// As on a full disk: no file can grow beyond `limit` bytes. Exit code 0 if the writer said so in words.
int write_beyond(const std::filesystem::path& folder, std::uint64_t limit, int pairs_that_fit) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{limit, limit};
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::mt19937 random(1);
  try {
    RecordingWriter writer(folder, plain_pair(160, 120), {.compress = true});
    const Picture flat{160, 120, 1, 8, std::vector<std::uint8_t>(160 * 120, 90)};
    for (int i = 0; i < pairs_that_fit; ++i) writer.write({i * 1'000'000, flat, flat});
    writer.write({1'000'000'000, flat, noise(160, 120, random)});
  } catch (const std::exception& error) {
    const std::string words = error.what();
    return words.find("cam1") != std::string::npos && words.find("disk full") != std::string::npos ? 0 : 2;
  }
  return 3;  // nobody noticed
}

TEST(UnbreakableRecording, AFullDiskIsSaidAndCostsOnlyThePairThatDoesNotFit) {
  const testing::TemporaryFolder folder;
  const pid_t writer = ::fork();
  if (writer == 0) ::_exit(write_beyond(folder.path(), 8000, 5));
  int status = 0;
  ::waitpid(writer, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(count_whole_pairs(folder.path()), 5);
}

TEST(UnbreakableRecording, TheCalibrationComesBackToTheLastBit) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto some_pose = [&] {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        Eigen::Quaterniond(any(random), any(random), any(random), 1.5).normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(any(random), any(random), any(random));
    return pose;
  };
  for (int i = 0; i < 20; ++i) {
    const testing::TemporaryFolder folder;
    StereoCalibration pair = plain_pair(160, 120);
    pair.body_from_left = some_pose();
    pair.right_from_left = some_pose();
    RecordingWriter writer(folder.path(), pair, {});
    writer.write({0, noise(160, 120, random), noise(160, 120, random)});
    const auto read = open_source({.spec = "euroc:" + folder.path().string()})->calibration();
    EXPECT_EQ(read->right_from_left.matrix(), pair.right_from_left.matrix());
    EXPECT_EQ(read->body_from_left.matrix(), pair.body_from_left.matrix());
  }
}

TEST(UnbreakableRecording, GravityIsKept) {
  const testing::TemporaryFolder folder;
  std::mt19937 random(1);
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.9, 0.2).normalized();
  RecordingWriter writer(folder.path(), plain_pair(160, 120), {.up_in_left_camera = up});
  writer.write({0, noise(160, 120, random), noise(160, 120, random)});
  const auto source = open_source({.spec = "euroc:" + folder.path().string()});
  ASSERT_TRUE(source->up_in_left_camera());
  EXPECT_TRUE(source->up_in_left_camera()->isApprox(up, 1e-12));
}

TEST(UnbreakableRecording, HowALivePairWasTakenStandsBesideIt) {
  const testing::TemporaryFolder folder;
  std::mt19937 random(1);
  RecordingWriter writer(folder.path(), plain_pair(160, 120), {.about = "{}"});
  writer.write({7,
                noise(160, 120, random),
                noise(160, 120, random),
                {.skew_ns = -300, .exposure_us = 5000, .gain = 2}});
  std::ifstream in(folder.path() / "mav0" / "capture.csv");
  std::string header, line;
  std::getline(in, header);
  std::getline(in, line);
  EXPECT_EQ(line, "7,-300,5000,2");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "recording.json"));
  const auto skew = open_source({.spec = "euroc:" + folder.path().string()})->skew();
  ASSERT_TRUE(skew);
  EXPECT_EQ(skew->histogram.total(), 1);
  EXPECT_NEAR(skew->histogram.largest_ms, 0.0003, 1e-9);
}

}  // namespace
}  // namespace flogmap
