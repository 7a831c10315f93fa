// GET /maps/{id}/views, /maps/{id}/views/{n}.glb: the mapped views that are kept, and their textured meshes.
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/views/glb.hpp"
#include "server/views/view_codec.hpp"
#include "server/views/view_mesh.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const StereoCamera& camera) {
  return {{"focal_px", camera.focal_px}, {"cx_px", camera.cx_px},         {"cy_px", camera.cy_px},
          {"width_px", camera.width_px}, {"height_px", camera.height_px}, {"baseline_m", camera.baseline_m}};
}

ApiAnswer get_views(const ApiRequest& request, ServerState& state) {
  const ServedMap& map = requested_map(request, state);
  const std::vector<SE3> poses = poses_on_path(map.views().all(), map.trajectory());
  Json views = Json::array();
  for (const auto& [number, view] : map.views().all()) {
    const SE3& pose = poses[views.size()];
    const Eigen::Vector3d t = pose.translation();
    const Eigen::Quaterniond q(pose.rotation());
    views.push_back({{"number", number},
                     {"time_ns", std::to_string(view->timestamp_ns)},
                     {"position", {t.x(), t.y(), t.z()}},
                     {"orientation_xyzw", {q.x(), q.y(), q.z(), q.w()}}});
  }
  const Json answer = {
      {"epoch", map.epoch()}, {"rev", map.revision()}, {"camera", to_json(map.camera())}, {"views", views}};
  return tagged_json(answer.dump(), etag_with_path(map, request, state.options));
}

SharedView requested_view(const ApiRequest& request, const ServedMap& map) {
  constexpr std::string_view kEnding = ".glb";
  std::string_view name = request.captures.at(1);
  if (!name.ends_with(kEnding)) throw RefusedRequest(404, "not-found", "views are named {number}.glb", "n");
  name.remove_suffix(kEnding.size());
  const std::int64_t number = parse_integer(name, "n", 0, INT64_MAX);
  if (SharedView view = map.views().find(number)) return view;
  throw RefusedRequest(
      404, "no-such-view",
      "view " + std::to_string(number) + " is not kept; see /api/v1/maps/" + map.id() + "/views", "n");
}

ApiResponse mesh_response(const StoredView& view, const SE3& pose, const StereoCamera& camera) {
  const auto unpacked = unpack_view(view);
  if (!unpacked) return problem(404, "no-mesh", "this view was kept by another program and has no mesh");
  ApiResponse response;
  response.content_type = "model/gltf-binary";
  response.body = to_shared(
      glb_of(mesh_of(*unpacked, camera), unpacked->jpeg, pose, "view " + std::to_string(view.number)));
  return response;
}

/// The same view has another file when its pose was corrected.
std::string tag_of(const ServedMap& map, const StoredView& view, const SE3& pose) {
  std::size_t digest = 0;
  for (int i = 0; i < 12; ++i) digest = digest * 31 + std::hash<double>{}(pose.matrix()(i % 3, i / 3));
  return make_etag(map.epoch(), static_cast<std::uint64_t>(view.number), "glb-" + std::to_string(digest));
}

ApiAnswer get_mesh(const ApiRequest& request, ServerState& state) {
  const ServedMap& map = requested_map(request, state);
  const SharedView view = requested_view(request, map);
  const SE3 pose = poses_on_path({{view->number, view}}, map.trajectory()).front();
  const std::string etag = tag_of(map, *view, pose);
  if (is_known(request, etag)) return nothing_new(etag);
  return ApiJob([view, pose, camera = map.camera(), etag] {
    ApiResponse response = mesh_response(*view, pose, camera);
    if (response.status != 200) return response;
    response.etag = etag;
    response.cache_control = "private, no-cache";
    return response;
  });
}

}  // namespace

std::vector<Route> view_routes() {
  return {{Method::get, "/api/v1/maps/{}/views", Role::view, get_views},
          {Method::get, "/api/v1/maps/{}/views/{}", Role::view, get_mesh}};
}

}  // namespace flogmap
