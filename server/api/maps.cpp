// GET /maps, /maps/{id}
#include <nlohmann/json.hpp>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

std::string_view name_of(Operators operators) {
  switch (operators) {
    case Operators::minmax:
      return "minmax";
    case Operators::lukasiewicz:
      return "lukasiewicz";
    case Operators::algebraic:
      break;
  }
  return "algebraic";
}

Json to_json(const MapInfo& info) {
  Json layers = Json::array();
  for (int k = 0; k < info.grid.num_layers(); ++k) {
    layers.push_back({{"id", k},
                      {"name", layer_name(info.grid, k)},
                      {"z_min", info.grid.layer_bounds_m[k]},
                      {"z_max", info.grid.layer_bounds_m[k + 1]},
                      {"full_confidence_rays", info.full_confidence_rays[k]}});
  }
  return layers;
}

Json to_json(const ServedMap& map) {
  const MapHeader header = map.header();
  Json json = {{"id", map.id()},
               {"epoch", header.epoch},
               {"rev", header.revision},
               {"cell_size", header.info.grid.cell_size_m},
               {"tile_size", kTileSide},
               {"levels", kOverviewLevels},
               {"layers", to_json(header.info)},
               {"bounds", nullptr},
               {"tiles", map.board().tiles().size()},
               {"min_rays", header.info.min_rays},
               {"operators", name_of(header.operators)}};
  if (const auto& b = header.bounds) {
    json["bounds"] = {{"x_min", b->x_min}, {"y_min", b->y_min}, {"x_max", b->x_max}, {"y_max", b->y_max}};
  }
  return json;
}

ApiAnswer get_maps(const ApiRequest&, ServerState& state) {
  Json maps = Json::array();
  if (state.live) maps.push_back(to_json(*state.live));
  for (const auto& [id, map] : state.stored) maps.push_back(to_json(*map));
  std::string text = Json{{"maps", maps}}.dump();
  const std::string etag = etag_of_text(text);
  return tagged_json(std::move(text), etag);
}

ApiAnswer get_map(const ApiRequest& request, ServerState& state) {
  const ServedMap& map = requested_map(request, state);
  return tagged_json(to_json(map).dump(), etag_of(map, request, state.options));
}

}  // namespace

std::vector<Route> map_routes() {
  return {{Method::get, "/api/v1/maps", Role::view, get_maps},
          {Method::get, "/api/v1/maps/{}", Role::view, get_map}};
}

}  // namespace flogmap
