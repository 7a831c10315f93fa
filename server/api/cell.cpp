// GET /maps/{id}/cell?x=&y=
#include <nlohmann/json.hpp>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/cell_inspection.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

ApiAnswer get_cell(const ApiRequest& request, ServerState& state) {
  ServedMap& map = requested_map(request, state);
  const double x_m = required_number(request, "x"), y_m = required_number(request, "y");
  const GridSpec& grid = map.board().info().grid;
  if (!has_cell(grid, x_m, y_m)) throw RefusedRequest(400, "bad-parameter", "no cell lies so far out", "x");
  const CellColumn column = inspect_cell(map, x_m, y_m);
  const CellIndex cell = cell_at(grid, x_m, y_m);
  Json layers = Json::array();
  for (const CellEvidence& evidence : column.layers) {
    layers.push_back({{"layer", evidence.layer},
                      {"E", evidence.empty},
                      {"O", evidence.occupied},
                      {"K", evidence.confidence},
                      {"N", evidence.rays},
                      {"M", evidence.value},
                      {"M_p", evidence.planning},
                      {"M_m", evidence.motion},
                      {"conflict", evidence.conflict},
                      {"change", evidence.change}});
  }
  const Json json = {{"x", x_m},
                     {"y", y_m},
                     {"i", cell.x},
                     {"j", cell.y},
                     {"epoch", column.epoch},
                     {"rev", column.revision},
                     {"layers", layers}};
  return tagged_json(json.dump(), etag_of(map, request, state.options));
}

}  // namespace

std::vector<Route> cell_routes() { return {{Method::get, "/api/v1/maps/{}/cell", Role::view, get_cell}}; }

}  // namespace flogmap
