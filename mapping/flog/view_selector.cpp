#include "mapping/flog/view_selector.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace flogmap {
namespace {

/// Half the horizontal field of view, radians.
double half_field_of_view(const StereoCamera& camera) {
  return (std::atan2(camera.cx_px + 0.5, camera.focal_px) +
          std::atan2(camera.width_px - 0.5 - camera.cx_px, camera.focal_px)) /
         2;
}

/// Full three-dimensional angle between two orientations: acos((tr R - 1)/2), radians.
double angle_between(const SE3& a, const SE3& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

void require(bool allowed, const char* field, double value, const char* what) {
  if (!allowed)
    throw std::invalid_argument(std::string(field) + " must be " + what + ", got " + std::to_string(value));
}

}  // namespace

void check(const ViewSelectorOptions& options) {
  require(options.translation_cells > 0, "translation_cells", options.translation_cells, "> 0");
  require(options.translation_m >= 0, "translation_m", options.translation_m, ">= 0 (0: by cells)");
  require(options.cell_size_m > 0, "cell_size_m", options.cell_size_m, "> 0");
  require(options.rotation_rad >= 0, "rotation_rad", options.rotation_rad,
          ">= 0 (0: half the field of view)");
}

ViewSelector::ViewSelector(const ViewSelectorOptions& options, const StereoCamera& camera)
    : translation_m_(options.translation_m > 0 ? options.translation_m
                                               : options.translation_cells * options.cell_size_m),
      rotation_rad_(options.rotation_rad > 0 ? options.rotation_rad : half_field_of_view(camera)) {
  check(options);
}

bool ViewSelector::accept(const SE3& world_from_camera) {
  if (last_) {
    // A path of exactly four cells, added up from small steps, must not miss by a rounding error.
    const double moved_m = (world_from_camera.translation() - last_->translation()).norm() * (1 + 1e-9);
    if (moved_m < translation_m_ && angle_between(*last_, world_from_camera) <= rotation_rad_) return false;
  }
  last_ = world_from_camera;
  return true;
}

}  // namespace flogmap
