// Directions seen from above, in bins as fine as the columns of the picture. FLOG.md section 7,
// point 1.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "mapping/flog/ray_model.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// A narrow range of azimuths: its middle as a unit vector, world, and the tangent of half its angle.
struct AzimuthSpread {
  Eigen::Vector2d direction;
  double half_tangent = 0;
};

/// The circle is cut into four sectors around the camera's heading and across it; within a sector bins are
/// even in the tangent, so that for a level camera every column of the picture is one bin, and its direction
/// the bin's.
struct AzimuthBins {
  Eigen::Vector2d heading;  // unit vector, world: the middle of sector 0; sector 1 is to its left
  double per_tangent = 0;   // bins per unit of the tangent
  double middle = 0;        // place within a sector where the tangent is 0
  int per_sector = 0;

  [[nodiscard]] int count() const { return 4 * per_sector; }

  /// Unit vector of a bin, world: of its middle, or `aside` (-0.5 to 0.5, to the left) of its width beside
  /// it.
  [[nodiscard]] Eigen::Vector2d direction(int bin, double aside) const {
    const double tangent = (bin % per_sector + aside - middle) / per_tangent;
    Eigen::Vector2d ahead = heading;
    for (int quarter = 0; quarter < bin / per_sector; ++quarter) ahead = left_of(ahead);
    return (ahead + tangent * left_of(ahead)).normalized();
  }

  /// From `first` to `last` of the width of a bin.
  [[nodiscard]] AzimuthSpread spread(int bin, double first, double last) const {
    const Eigen::Vector2d right = direction(bin, first), left = direction(bin, last);
    const Eigen::Vector2d between = (left + right).normalized();
    return {between, left.dot(left_of(between)) / left.dot(between)};
  }

  static Eigen::Vector2d left_of(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }
};

/// Where a camera heads, seen from above: its view axis, or, if it looks steeply up or down, its upright
/// axis.
inline Eigen::Vector2d heading_of(const SE3& world_from_camera) {
  const Eigen::Vector2d ahead = world_from_camera.linear().col(2).head<2>();
  const Eigen::Vector2d upright = world_from_camera.linear().col(1).head<2>();
  return (ahead.norm() >= 0.5 * upright.norm() ? ahead : upright).normalized();
}

/// Two bins per column of the picture: for a level camera every second one stays empty, for any other the
/// counts of far cells come out twice as even.
inline AzimuthBins azimuth_bins(const RayModel& model, const SE3& world_from_camera) {
  const double per_column = 2.0 / model.column_step;
  const double per_tangent =
      std::min(model.camera.focal_px * per_column, 8000.0);  // a bin's number has 16 bits
  const double first = model.camera.cx_px * per_column;
  const double half = std::ceil(per_tangent) + 2;
  return {heading_of(world_from_camera), per_tangent, half - (first - std::floor(first)),
          2 * static_cast<int>(half) + 1};
}

}  // namespace flogmap
