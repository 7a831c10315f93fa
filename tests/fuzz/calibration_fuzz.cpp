// Every calibration dialect: one file, or two with a line "=====" between them. A reader takes it or throws
// std::runtime_error; what it takes can be used.
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "camera/calibration/detect.hpp"
#include "camera/calibration/distortion.hpp"
#include "tests/fuzz/scratch_folder.hpp"

namespace {

using flogmap::fuzz::next_part;
using flogmap::fuzz::ScratchFolder;

void use(const flogmap::CameraIntrinsics& camera) {
  for (const double x : {0.0, 100.0, 1e4}) {
    const auto ray = flogmap::ray_from_pixel(camera, {x, x / 2});
    if (ray && ray->z() > 0) (void)flogmap::pixel_from_ray(camera, *ray);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::string path = folder.write("left", next_part(rest)).string();
  if (!rest.empty()) path += "," + folder.write("right", rest).string();
  try {
    const flogmap::StereoCalibration calibration = flogmap::read_calibration(path);
    use(calibration.left);
    use(calibration.right);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
