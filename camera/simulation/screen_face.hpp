#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "camera/simulation/faces.hpp"
#include "camera/stereo_camera.hpp"

namespace flogmap {

/// A quantity that is an affine function of the pixel.
struct Affine {
  double at_origin = 0, per_x = 0, per_y = 0;
  [[nodiscard]] double operator()(double x, double y) const { return at_origin + per_x * x + per_y * y; }
};

/// A face as one camera sees it. Over a plane, 1/Z and (texture coordinate)/Z are affine functions of the
/// pixel: that makes depth and texture exact at every pixel, with one division.
struct ScreenFace {
  std::size_t face = 0;
  Affine inverse_depth;               // 1/Z [1/m]
  Affine u_over_depth, v_over_depth;  // texels/m; u = u_over_depth / inverse_depth - u_origin
  double u_origin = 0, v_origin = 0;  // texels
  std::vector<Eigen::Vector2d> corners_px;
  std::vector<Affine> edges_px;  // signed distances from the edges, positive inside
  int first_row = 0, last_row = -1;

  /// The pixels of a row whose centres lie inside: [first, last); empty if first >= last.
  struct Span {
    int first, last;
  };
  [[nodiscard]] Span span(int row, int width_px) const;
  [[nodiscard]] bool contains(double x, double y) const;
};

/// Projects a face; nothing if it is turned away, behind the camera or outside the picture.
[[nodiscard]] std::optional<ScreenFace> project(const Face& face, std::size_t index, double texel_m,
                                                const Eigen::Isometry3d& camera_from_face,
                                                const StereoCamera& camera);

}  // namespace flogmap
