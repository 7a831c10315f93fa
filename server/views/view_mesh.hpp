// A textured surface from one view's own disparity, for the walkthrough.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "server/views/view_codec.hpp"

namespace flogmap {

/// Vertices in the rectified left camera (x right, y down, z forward; metres), triangles counter-clockwise as
/// the camera sees them.
struct ViewMesh {
  struct Vertex {
    std::array<float, 3> position_m;
    std::array<std::uint16_t, 2> texture;  // 0 .. 65535 = left .. right, top .. bottom edge of the picture
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct ViewMeshOptions {
  /// What is nearer to infinity than this is left out: its depth is off by more than a tenth.
  double min_disparity_px = 3;
  /// A surface's disparity changes less than this from a pixel to the next (the segment filter's own rule)
  /// ...
  double max_step_px = 1;
  /// ... and its depth by less than this ratio along a triangle's side.
  double max_depth_ratio = 1.12;
};

/// A vertex for every second sample in both directions: the median of the nine samples around it, where at
/// least five have a match. Cut at depth steps; nothing is filled in. Eq. (1).
ViewMesh mesh_of(const UnpackedView& view, const StereoCamera& camera, const ViewMeshOptions& options = {});

}  // namespace flogmap
