#include "server/views/view_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/triangulate.hpp"

namespace flogmap {
namespace {

constexpr int kStride = 2;              // samples from a vertex to the next
constexpr std::size_t kMinMatches = 5;  // of the nine samples around a vertex
constexpr float kNone = 0;              // disparity of a vertex that is not there
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// The median disparity around a sample; kNone with too few matches, or too far away.
float vertex_disparity(const Image<float>& disparity, int x, int y, double least) {
  std::array<float, 9> around{};
  std::size_t count = 0;
  for (int j = std::max(0, y - 1); j <= std::min(disparity.height - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(disparity.width - 1, x + 1); ++i) {
      if (!std::isnan(disparity.at(i, j))) around[count++] = disparity.at(i, j);
    }
  }
  if (count < kMinMatches) return kNone;
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle >= static_cast<float>(least) ? *middle : kNone;
}

class MeshBuilder {
 public:
  MeshBuilder(const UnpackedView& view, const StereoCamera& camera, const ViewMeshOptions& options)
      : view_(view),
        camera_(camera),
        options_(options),
        corners_((view.disparity_px.width + kStride - 1) / kStride,
                 (view.disparity_px.height + kStride - 1) / kStride, kNone),
        index_(corners_.width, corners_.height, kUnused) {
    for (int j = 0; j < corners_.height; ++j) {
      for (int i = 0; i < corners_.width; ++i) {
        corners_.at(i, j) =
            vertex_disparity(view.disparity_px, i * kStride, j * kStride, options.min_disparity_px);
      }
    }
  }

  ViewMesh build() {
    for (int j = 0; j + 1 < corners_.height; ++j) {
      for (int i = 0; i + 1 < corners_.width; ++i) add_square(i, j);
    }
    return std::move(mesh_);
  }

 private:
  struct Corner {
    int i, j;
  };

  [[nodiscard]] float at(Corner c) const { return corners_.at(c.i, c.j); }

  /// Two triangles, parted along the diagonal whose ends are nearer to each other in depth.
  void add_square(int i, int j) {
    const Corner a{i, j}, b{i + 1, j}, c{i + 1, j + 1}, d{i, j + 1};
    const bool other =
        at(a) == kNone || at(c) == kNone ||
        (at(b) != kNone && at(d) != kNone && std::abs(at(b) - at(d)) < std::abs(at(a) - at(c)));
    if (other) {
      add_triangle(a, d, b);
      add_triangle(b, d, c);
    } else {
      add_triangle(a, d, c);
      add_triangle(a, c, b);
    }
  }

  void add_triangle(Corner a, Corner b, Corner c) {
    const auto [least, most] = std::minmax({at(a), at(b), at(c)});
    if (least == kNone || most > least * static_cast<float>(options_.max_depth_ratio)) return;
    const double pixels = double(kStride) * view_.step;
    if (double(most) - least > options_.max_step_px * pixels) return;
    mesh_.triangles.push_back({vertex(a), vertex(b), vertex(c)});
  }

  std::uint32_t vertex(Corner c) {
    std::uint32_t& index = index_.at(c.i, c.j);
    if (index != kUnused) return index;
    index = static_cast<std::uint32_t>(mesh_.vertices.size());
    const double x = c.i * kStride * view_.step, y = c.j * kStride * view_.step;
    const Eigen::Vector3f p = triangulate(camera_, x, y, at(c)).cast<float>();
    const auto part = [](double pixel, int length) {
      return static_cast<std::uint16_t>(std::lround(65535 * (pixel + 0.5) / length));
    };
    mesh_.vertices.push_back({{p.x(), p.y(), p.z()}, {part(x, view_.width_px), part(y, view_.height_px)}});
    return index;
  }

  const UnpackedView& view_;
  const StereoCamera& camera_;
  const ViewMeshOptions options_;
  Image<float> corners_;
  Image<std::uint32_t> index_;  // of a corner's vertex
  ViewMesh mesh_;
};

}  // namespace

ViewMesh mesh_of(const UnpackedView& view, const StereoCamera& camera, const ViewMeshOptions& options) {
  return MeshBuilder(view, camera, options).build();
}

}  // namespace flogmap
