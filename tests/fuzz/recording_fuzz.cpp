// Lists of recordings, parts between lines "=====": EuRoC's data.csv left, right and of the inertial sensor,
// then KITTI's times.txt and calib.txt; and the first part as a trajectory.
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
    for (const char* camera : {"image_0", "image_1"}) {
      for (const char* picture : {"000000.png", "000001.png"}) {
        folder.write(std::filesystem::path("kitti") / camera / picture, "");
      }
    }
    return true;
  }();
  (void)prepared;
  return folder;
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
  folder.write("kitti/times.txt", next_part(rest));
  folder.write("kitti/calib.txt", rest);
  take_or_refuse([&] { (void)flogmap::list_euroc(folder.path() / "euroc", false); });
  take_or_refuse(
      [&] { (void)flogmap::inertial_up(folder.path() / "euroc/mav0/imu0", Eigen::Isometry3d::Identity()); });
  take_or_refuse([&] { (void)flogmap::list_kitti(folder.path() / "kitti", true); });
  take_or_refuse([&] { (void)flogmap::read_trajectory(left); });
  return 0;
}
