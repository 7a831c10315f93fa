// How somebody turned and raised the world by hand, where the automatic start was wrong.
#pragma once

#include "mapping/view.hpp"

namespace flogmap {

/// The paper aligns the first camera so. First rolled about x, then pitched about y, then turned about z,
/// each about the world's origin by the right-hand rule; then raised. All zero: nothing was done.
struct HandLevel {
  double roll_rad = 0;   // +: what lies to the left (y) rises
  double pitch_rad = 0;  // +: what lies ahead (x) sinks
  double yaw_rad = 0;    // +: to the left
  double height_m = 0;   // added to every z
  bool operator==(const HandLevel&) const = default;

  [[nodiscard]] bool is_level() const { return *this == HandLevel{}; }

  /// Where a point of the automatic start's world lies in the world as levelled by hand.
  [[nodiscard]] SE3 map_from_start() const {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    SE3 moved = SE3::Identity();
    moved.linear() = (AngleAxisd(yaw_rad, Vector3d::UnitZ()) * AngleAxisd(pitch_rad, Vector3d::UnitY()) *
                      AngleAxisd(roll_rad, Vector3d::UnitX()))
                         .toRotationMatrix();
    moved.translation() = Vector3d(0, 0, height_m);
    return moved;
  }
};

}  // namespace flogmap
