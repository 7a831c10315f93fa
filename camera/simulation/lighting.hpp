#pragma once

#include <vector>

#include "camera/simulation/faces.hpp"
#include "camera/simulation/mip_texture.hpp"
#include "camera/simulation/scene.hpp"

namespace flogmap {

/// Paints every face: reflectance (pattern or picture) times the light that reaches it, with soft shadows and
/// dimmed corners. Texel (i, j) of face k covers [i, i+1) x [j, j+1) times `texel_m` of its frame. Throws
/// std::runtime_error naming a material's unknown pattern or unreadable picture.
[[nodiscard]] std::vector<MipTexture> paint_faces(const Scene& scene, const std::vector<Face>& faces);

/// The texel size used for a face: its material's or the scene's, or larger where the face would need more
/// than 4096 texels a side.
[[nodiscard]] double texel_size_m(const Scene& scene, const Face& face);

}  // namespace flogmap
