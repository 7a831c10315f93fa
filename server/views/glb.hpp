// A textured mesh as binary glTF 2.0 (GLB).
#pragma once

#include <string>

#include "mapping/view.hpp"
#include "server/views/view_mesh.hpp"

namespace flogmap {

/// One mesh with one unlit JPEG texture. The node "view" holds the camera's pose, its parent turns the world
/// (z up) into glTF's (y up); vertices stay in the camera's own frame, so that a corrected pose needs no new
/// mesh. Khronos glTF 2.0 specification, sections 3 and 4.4 (the container). A mesh without triangles gives a
/// scene without a mesh.
std::string glb_of(const ViewMesh& mesh, const std::string& jpeg, const SE3& world_from_camera,
                   const std::string& name);

}  // namespace flogmap
