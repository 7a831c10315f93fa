#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "camera/image.hpp"
#include "camera/simulation/faces.hpp"
#include "camera/simulation/mip_texture.hpp"
#include "camera/simulation/scene.hpp"
#include "camera/simulation/screen_face.hpp"

namespace flogmap {

/// One picture of the scene and what is known of it.
struct RenderedView {
  Image<std::uint8_t> grey;
  Image<float> inverse_depth;  // 1/Z at pixel centres [1/m]; 0 where there is nothing
};

/// Draws the scene: visibility by the exact depth of every face at every pixel centre, then texture filtered
/// to the pixel's footprint, then the pixels on outlines again with several samples each. Not for use by two
/// threads at once.
class Renderer {
 public:
  /// Paints the faces, which takes about a second for a room.
  explicit Renderer(Scene scene);

  /// The picture of one pinhole camera (the scene's) at a time; z of the camera forward, y down.
  void render(const Eigen::Isometry3d& world_from_camera, double time_s, RenderedView& view);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }

 private:
  void project_faces(const Eigen::Isometry3d& world_from_camera, double time_s);
  void find_visible(RenderedView& view);
  void shade(RenderedView& view) const;
  void smooth_outlines(RenderedView& view) const;
  [[nodiscard]] bool is_outline(int x, int y) const;
  [[nodiscard]] std::uint8_t outline_grey(int x, int y, std::uint8_t otherwise) const;
  [[nodiscard]] std::int32_t nearest_at(double x, double y, std::span<const std::int32_t> candidates) const;
  [[nodiscard]] std::uint8_t mean_grey(int x, int y, std::span<const std::int32_t> nearest) const;

  Scene scene_;
  std::vector<Face> faces_;
  std::vector<double> texels_m_;
  std::vector<MipTexture> textures_;
  std::vector<ScreenFace> screen_;       // of the picture being drawn
  std::vector<std::uint32_t> outlines_;  // per screen face: faces with one number are one smooth surface
  Image<std::int32_t> visible_;          // index into screen_, -1 for nothing
};

/// Where a solid is at a time, against where the scene puts it; nothing if it is not there.
[[nodiscard]] std::optional<Eigen::Vector3d> shift_at(const Solid& solid, double time_s);

}  // namespace flogmap
