// POST /maps/{id}/tiles:batchGet {"tiles": [{"level", "x", "y", "rev"?}], "layers"?: [], "planes"?: ""}
#include <algorithm>

#include "server/api/json_body.hpp"
#include "server/api/resources.hpp"
#include "server/api/tile_json.hpp"

namespace flogmap {
namespace {

constexpr std::size_t kMaxTiles = 256;

struct WantedTile {
  TileKey key;
  std::uint64_t known_revision = 0;
};

std::int64_t integer_field(const nlohmann::json& object, const char* name, std::int64_t least,
                           std::int64_t most) {
  if (object.contains(name) && object[name].is_number_integer()) {
    const auto value = object[name].get<std::int64_t>();
    if (value >= least && value <= most) return value;
  }
  throw RefusedRequest(422, "bad-value", std::string("each tile needs an integer ") + name + " in range",
                       name);
}

std::vector<WantedTile> wanted_tiles(const nlohmann::json& body) {
  if (!body.contains("tiles") || !body["tiles"].is_array()) {
    throw RefusedRequest(422, "missing-field", "tiles must be an array", "tiles");
  }
  if (body["tiles"].size() > kMaxTiles) throw RefusedRequest(422, "too-many", "at most 256 tiles", "tiles");
  std::vector<WantedTile> wanted;
  for (const auto& tile : body["tiles"]) {
    if (!tile.is_object()) throw RefusedRequest(422, "bad-value", "each tile must be an object", "tiles");
    WantedTile one;
    one.key.level = static_cast<std::uint32_t>(integer_field(tile, "level", 0, kOverviewLevels - 1));
    one.key.x = static_cast<std::int32_t>(integer_field(tile, "x", INT32_MIN, INT32_MAX));
    one.key.y = static_cast<std::int32_t>(integer_field(tile, "y", INT32_MIN, INT32_MAX));
    if (tile.contains("rev"))
      one.known_revision = static_cast<std::uint64_t>(integer_field(tile, "rev", 0, INT64_MAX));
    wanted.push_back(one);
  }
  return wanted;
}

TileChoice wanted_choice(const nlohmann::json& body, const MapInfo& info) {
  TileChoice choice{{}, Planes::evidence};
  if (body.contains("planes")) {
    if (body["planes"] != "value" && body["planes"] != "evidence") {
      throw RefusedRequest(422, "bad-value", "planes must be value or evidence", "planes");
    }
    if (body["planes"] == "value") choice.planes = Planes::value;
  }
  if (!body.contains("layers")) return choice;
  if (!body["layers"].is_array()) throw RefusedRequest(422, "bad-value", "layers must be an array", "layers");
  for (const auto& layer : body["layers"]) {
    const bool known = layer.is_number_integer() && layer.get<std::int64_t>() >= 0 &&
                       layer.get<std::int64_t>() < info.grid.num_layers();
    if (!known) throw RefusedRequest(422, "bad-value", "there is no such layer", "layers");
    choice.layers.push_back(layer.get<int>());
  }
  std::sort(choice.layers.begin(), choice.layers.end());
  choice.layers.erase(std::unique(choice.layers.begin(), choice.layers.end()), choice.layers.end());
  return choice;
}

/// Those that exist and are newer than what the client has; tiles that were removed after that.
void sort_out(const ServedMap& map, const std::vector<WantedTile>& wanted, std::vector<Slot>& newer,
              std::vector<TileKey>& removed) {
  const TileBoard& board = map.board();
  for (const WantedTile& tile : wanted) {
    const auto slot = board.find(tile.key);
    const bool never_was = tile.known_revision > map.revision();  // of a killed program, never stored
    if (!slot || (board.revision(*slot) <= tile.known_revision && !never_was)) continue;
    if (board.exists(*slot)) {
      newer.push_back(*slot);
    } else if (tile.known_revision > 0) {
      removed.push_back(tile.key);
    }
  }
}

nlohmann::ordered_json batch_json(ServedMap& map, const std::vector<Slot>& newer,
                                  const std::vector<TileKey>& removed, const std::vector<int>& layers) {
  nlohmann::ordered_json json = {{"epoch", map.epoch()}, {"rev", map.revision()}};
  json["tiles"] = json["removed"] = nlohmann::ordered_json::array();
  for (const Slot slot : newer) json["tiles"].push_back(tile_json(map.board(), slot, layers));
  for (const TileKey& key : removed) {
    json["removed"].push_back({{"level", key.level}, {"x", key.x}, {"y", key.y}});
  }
  return json;
}

ApiAnswer batch_get(const ApiRequest& request, ServerState& state) {
  ServedMap& map = requested_map(request, state);
  const nlohmann::json body = json_body(request);
  const TileChoice choice = wanted_choice(body, map.board().info());
  std::vector<Slot> newer;
  std::vector<TileKey> removed;
  sort_out(map, wanted_tiles(body), newer, removed);
  const auto type = negotiate(request.accept, {"application/x-protobuf", "application/json"});
  if (!type) throw RefusedRequest(406, "not-acceptable", "offered: application/x-protobuf, application/json");
  if (*type == "application/json") {
    return json_response(batch_json(map, newer, removed, choice.layers).dump());
  }
  std::vector<Bytes> tiles;
  for (const Slot slot : newer) tiles.push_back(map.board().message(slot, choice));
  ApiResponse response;
  response.content_type = "application/x-protobuf";  // a ServerMessage with a TileBatch
  response.body = to_shared(encode_tile_batch(map.revision(), false, tiles, removed));
  return response;
}

}  // namespace

std::vector<Route> batch_routes() {
  return {{Method::post, "/api/v1/maps/{}/tiles:batchGet", Role::view, batch_get}};
}

}  // namespace flogmap
