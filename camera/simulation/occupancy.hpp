#pragma once

#include <cstdint>
#include <vector>

#include "camera/image.hpp"
#include "camera/simulation/scene.hpp"

namespace flogmap {

/// True occupancy of one layer of cells at a time: 255 where a solid overlaps the cell's box (interiors
/// included, mere touching not), else 0. Row 0 is the lowest y. A hall counts as walls, floor and ceiling of
/// kHallWallM thickness.
[[nodiscard]] Image<std::uint8_t> true_occupancy(const Scene& scene, double z_min_m, double z_max_m,
                                                 double time_s);

inline constexpr double kHallWallM = 0.1;

/// What of every layer the camera could see: cells that a ray to a visible point within `reach_m` passed or
/// ended in, and, of these, the cells where one ended. Fed frame by frame. 255 or 0, row 0 at the lowest y.
class SeenCells {
 public:
  explicit SeenCells(const Truth& truth, double reach_m = 5);

  /// Inverse depth [1/m] of the left camera at every pixel.
  void add(const Image<float>& inverse_depth, const StereoCamera& camera,
           const Eigen::Isometry3d& world_from_left);

  [[nodiscard]] const std::vector<Image<std::uint8_t>>& layers() const { return layers_; }
  [[nodiscard]] const std::vector<Image<std::uint8_t>>& surfaces() const { return surfaces_; }

 private:
  using Layers = std::vector<Image<std::uint8_t>>;
  void mark(Layers& layers, const Eigen::Vector3d& point) const;
  Truth truth_;
  double reach_m_;
  Layers layers_, surfaces_;
};

/// Columns and rows of a truth picture.
[[nodiscard]] Eigen::Vector2i truth_size(const Truth& truth);

}  // namespace flogmap
