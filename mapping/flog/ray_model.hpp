// From a pixel with a disparity to the ray that the map is told of. FLOG.md sections 1 and 2.
#pragma once

#include <cmath>
#include <optional>

#include "camera/stereo_camera.hpp"
#include "mapping/flog/flog_options.hpp"
#include "mapping/flog/membership.hpp"
#include "mapping/flog/ray_cells.hpp"
#include "mapping/triangulate.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// What turns the pixels of every view of a map into rays.
struct RayModel {
  StereoCamera camera;
  RangeError error;
  double max_range_m = 5;
  int row_step = 1;
  int column_step = 1;
};

inline RayModel ray_model(const FlogOptions& options, const StereoCamera& camera) {
  return {camera, range_error(camera, options.grid.cell_size_m, options.paper_mode), options.max_range_m,
          options.row_step, options.column_step};
}

/// A ray to a measured point. It touches cells as far as ray.length_m: through the hit, or, if the hit is
/// beyond the greatest range, only where it is surely free.
struct MeasuredRay {
  Ray ray;
  double l = 0;  // measured range, metres
  double m = 0;  // width of its memberships, metres
};

/// No ray where there is no (positive, finite) disparity.
inline std::optional<MeasuredRay> measured_ray(const RayModel& model, const SE3& world_from_camera,
                                               double x_px, double y_px, double disparity_px) {
  if (!(disparity_px > 0 && std::isfinite(disparity_px))) return std::nullopt;
  const Eigen::Vector3d p = triangulate(model.camera, x_px, y_px, disparity_px);
  const double l = p.norm();
  const double m = membership_width(model.error, l, p.z());
  const double length_m = l <= model.max_range_m ? l + m : std::min(model.max_range_m, l - m);
  if (!(length_m > 0)) return std::nullopt;
  return MeasuredRay{{world_from_camera.translation(), world_from_camera.linear() * p / l, length_m}, l, m};
}

/// No ray of this model touches a point farther from the camera than this; metres.
inline double reach_m(const RayModel& model) {
  const double R = model.max_range_m;
  return R + membership_width(model.error, R, R);
}

}  // namespace flogmap
