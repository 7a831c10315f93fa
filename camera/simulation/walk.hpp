#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "camera/simulation/scene.hpp"

namespace flogmap {

/// The camera's way through a scene as a function of time: a smooth curve through the path's points at
/// constant speed, and on it the unsteadiness of a hand.
class Walk {
 public:
  /// Throws std::runtime_error if the path has too few points (3 for a closed walk, 2 otherwise, 1 for
  /// steps).
  Walk(const Path& path, double rate_hz, std::uint64_t seed);

  /// world_from_left: x right, y down, z forward. Before the start and after the end of an open path it
  /// stands still.
  [[nodiscard]] Eigen::Isometry3d pose(double time_s) const;

  /// How long one round takes, or the whole of an open path.
  [[nodiscard]] double round_s() const { return round_s_; }

 private:
  struct Sway {
    double frequency_hz, phase_rad, share;
  };
  [[nodiscard]] double parameter(double time_s) const;
  [[nodiscard]] PathPoint on_curve(double parameter) const;
  [[nodiscard]] double unsteadiness(std::size_t channel, double time_s) const;

  Path path_;
  double rate_hz_ = 15;
  double round_s_ = 0;
  std::vector<double> length_m_;  // along the curve, at steps of the parameter
  std::vector<Sway> sways_;       // three for each of six channels
};

}  // namespace flogmap
