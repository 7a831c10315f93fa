// Takes libcamera's place in builds without it.
#include <stdexcept>

#include "camera/live/camera_rig.hpp"

namespace flogmap {
namespace {
[[noreturn]] void refuse() {
  throw std::runtime_error(
      "this build has no live cameras: libcamera was not found when it was built; install libcamera-dev and "
      "build "
      "again");
}
}  // namespace

std::unique_ptr<CameraRig> open_libcamera_rig(const RigOptions&) { refuse(); }
std::vector<CameraDescription> list_cameras() { refuse(); }

}  // namespace flogmap
