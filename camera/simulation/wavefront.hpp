#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace flogmap {

/// The triangles of a Wavefront OBJ file; polygons are cut into fans, everything but v and f is ignored.
struct WavefrontMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;  // anticlockwise from outside
};

/// Throws std::runtime_error naming file and line.
[[nodiscard]] WavefrontMesh read_wavefront(const std::filesystem::path& file);

}  // namespace flogmap
