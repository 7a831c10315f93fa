// Lists of recordings, parts between lines "=====": EuRoC's data.csv left, right and of the inertial sensor,
// then KITTI's times.txt, calib.txt and a fix of the inertial sensor; and the first part as a trajectory.
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "camera/euroc_source.hpp"
#include "camera/inertial_up.hpp"
#include "camera/kitti_source.hpp"
#include "mapping/odometry/trajectory_error.hpp"
#include "tests/fuzz/scratch_folder.hpp"

namespace {

using flogmap::fuzz::next_part;
using flogmap::fuzz::ScratchFolder;

constexpr const char* kSensor =
    "T_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n";

const ScratchFolder& prepared_folder() {
  static const ScratchFolder folder;
  static const bool prepared = [] {
    folder.write("euroc/mav0/imu0/sensor.yaml", kSensor);
    for (const char* camera : {"kitti/image_0", "kitti/image_1", "raw/image_00/data", "raw/image_01/data"}) {
      for (const char* picture : {"000000.png", "000001.png"}) {
        folder.write(std::filesystem::path(camera) / picture, "");
      }
    }
    return true;
  }();
  (void)prepared;
  return folder;
}

/// A sequence and a raw drive of the same lists.
void write_kitti(const ScratchFolder& folder, std::string_view times, std::string_view calibration,
                 std::string_view fix) {
  for (const char* file : {"kitti/times.txt", "raw/image_00/timestamps.txt"}) folder.write(file, times);
  for (const char* file : {"kitti/calib.txt", "raw/calib_cam_to_cam.txt", "raw/calib_imu_to_velo.txt",
                           "raw/calib_velo_to_cam.txt"}) {
    folder.write(file, calibration);
  }
  folder.write("raw/oxts/data/0000000000.txt", fix);
}

template <typename Function>
void take_or_refuse(const Function& read) {
  try {
    read();
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ScratchFolder& folder = prepared_folder();
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  const auto left = folder.write("euroc/mav0/cam0/data.csv", next_part(rest));
  folder.write("euroc/mav0/cam1/data.csv", next_part(rest));
  folder.write("euroc/mav0/imu0/data.csv", next_part(rest));
  const std::string_view times = next_part(rest), calibration = next_part(rest);
  write_kitti(folder, times, calibration, rest);
  take_or_refuse([&] { (void)flogmap::list_euroc(folder.path() / "euroc", false); });
  take_or_refuse(
      [&] { (void)flogmap::inertial_up(folder.path() / "euroc/mav0/imu0", Eigen::Isometry3d::Identity()); });
  for (const char* kitti : {"kitti", "raw"}) {
    take_or_refuse([&] { (void)flogmap::list_kitti(folder.path() / kitti, true, 10); });
  }
  take_or_refuse([&] { (void)flogmap::read_trajectory(left); });
  return 0;
}
