#pragma once

#include <gmock/gmock.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera/picture_files.hpp"
#include "camera/source_spec.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap::testing {

inline constexpr std::int64_t kStart = 1'700'000'000'000'000'000, kPeriod = 50'000'000;

inline std::string sensor_yaml(double x_m, const std::string& resolution = "[32, 24]") {
  return "T_BS:\n  data: [1, 0, 0, " + std::to_string(x_m) +
         ", 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nresolution: " + resolution +
         "\ncamera_model: pinhole\nintrinsics: [20, 20, 15.5, 11.5]\ndistortion_model: radial-tangential\n"
         "distortion_coefficients: [0, 0, 0, 0]\n";
}

inline Picture grey_picture(int tone, int width = 32, int height = 24) {
  return {
      width, height, 1, 8,
      std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height, static_cast<std::uint8_t>(tone))};
}

inline std::string stamp(int i) { return std::to_string(kStart + i * kPeriod); }

/// A small recording in the EuRoC layout: five pairs, 32x24, each of a tone of its own.
class Recordings : public ::testing::Test {
 protected:
  TemporaryFolder folder_;

  void SetUp() override { write_euroc(5); }

  void write_euroc(int count) {
    for (const char* camera : {"cam0", "cam1"}) {
      const std::filesystem::path base = std::filesystem::path("mav0") / camera;
      std::string csv = "#timestamp [ns],filename\r\n";
      folder_.write(base / "sensor.yaml", sensor_yaml(camera[3] == '0' ? 0 : 0.1));
      std::filesystem::create_directories(folder_.path() / base / "data");
      for (int i = 0; i < count; ++i) {
        csv += stamp(i) + "," + stamp(i) + ".png\r\n";
        ASSERT_TRUE(write_picture(picture(camera, i), grey_picture(10 * i + (camera[3] - '0'))));
      }
      folder_.write(base / "data.csv", csv);
    }
  }
  std::filesystem::path picture(const std::string& camera, int i) {
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
    EXPECT_THAT([&] { static_cast<void>(open()); },
                ::testing::ThrowsMessage<std::runtime_error>(::testing::HasSubstr(why)));
  }
};

}  // namespace flogmap::testing
