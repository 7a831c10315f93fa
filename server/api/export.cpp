// GET /maps/{id}/export?format=...: a file from an immutable snapshot.
#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/export/map_export.hpp"

namespace flogmap {
namespace {

ExportFormat requested_format(const ApiRequest& request) {
  const auto name = request.parameter("format");
  if (!name)
    throw RefusedRequest(400, "missing-parameter", "format is missing: ros, png, ply, pcd, bt, tum or kitti",
                         "format");
  try {
    return export_format(*name);
  } catch (const std::invalid_argument& error) {
    throw RefusedRequest(400, "bad-parameter", error.what(), "format");
  }
}

/// The map as the exports want it; the tiles are shared, not copied.
StoredMap stored_map(ServedMap& map, const ServerState& state) {
  StoredMap stored;
  stored.epoch = map.epoch();
  stored.info = map.board().info();
  stored.camera = map.camera();
  stored.revision = map.revision();
  for (const auto& [index, tile] : map.board().tiles()) stored.tiles.push_back({index, tile->revision, tile});
  stored.trajectory = map.trajectory();
  stored.options_json = state.info.config_json;
  stored.calibration_json = state.info.calibration_json;
  return stored;
}

ApiAnswer get_export(const ApiRequest& request, ServerState& state) {
  const ExportFormat format = requested_format(request);
  ServedMap& map = requested_map(request, state);
  ExportOptions options;
  options.layer = parse_layer(request.parameter("layer").value_or("fused"), map.board().info());
  options.rules.style = picture_choice(request, options.layer).style;
  options.rules.operators = state.options.operators;
  const std::string etag = etag_with_path(map, request, state.options);
  if (is_known(request, etag)) return nothing_new(etag);
  return ApiJob([stored = stored_map(map, state), format, options, etag] {
    ExportedFile file = export_bytes(format, stored, options);
    ApiResponse response = nothing_new(etag);
    response.content_type = file.content_type;
    response.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + file.name + "\"");
    response.body = to_shared(std::move(file.bytes));
    return response;
  });
}

}  // namespace

std::vector<Route> export_routes() {
  return {{Method::get, "/api/v1/maps/{}/export", Role::view, get_export}};
}

}  // namespace flogmap
