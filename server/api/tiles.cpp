// GET /maps/{id}/layers/{k|fused}/tiles/{level}/{tx}/{ty}
#include <algorithm>
#include <array>

#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/api/tile_json.hpp"

namespace flogmap {

nlohmann::ordered_json tile_json(TileBoard& board, Slot slot, const std::vector<int>& layers) {
  const TileKey key = board.key(slot);
  nlohmann::ordered_json json = {
      {"level", key.level}, {"x", key.x}, {"y", key.y}, {"rev", board.revision(slot)}};
  json["layers"] = nlohmann::ordered_json::array();
  for (int k = 0; k < board.info().grid.num_layers(); ++k) {
    if (!layers.empty() && !std::binary_search(layers.begin(), layers.end(), k)) continue;
    const PlaneBytes planes = evidence_planes(*board.tile(slot), k, board.info().full_confidence_rays[k]);
    const auto E = planes.begin(), O = E + kTileColumns, K = O + kTileColumns;
    json["layers"].push_back({{"layer", k},
                              {"E", PlaneBytes(E, O)},
                              {"O", PlaneBytes(O, K)},
                              {"K", PlaneBytes(K, planes.end())},
                              {"M", board.value(slot, k)}});
  }
  return json;
}

namespace {

enum class TileFormat : std::uint8_t { png, protobuf, json };

TileFormat requested_format(const ApiRequest& request) {
  if (const auto f = request.parameter("f")) {
    if (*f == "png") return TileFormat::png;
    if (*f == "pb") return TileFormat::protobuf;
    if (*f == "json") return TileFormat::json;
    throw RefusedRequest(400, "bad-parameter", "f must be png, pb or json", "f");
  }
  const auto type = negotiate(request.accept, {"image/png", "application/x-protobuf", "application/json"});
  if (!type)
    throw RefusedRequest(406, "not-acceptable",
                         "offered: image/png, application/x-protobuf, application/json");
  return *type == "image/png"          ? TileFormat::png
         : *type == "application/json" ? TileFormat::json
                                       : TileFormat::protobuf;
}

TileKey requested_key(const ApiRequest& request) {
  const std::int64_t level = parse_integer(request.captures[2], "level", 0, kOverviewLevels - 1);
  const std::int64_t x = parse_integer(request.captures[3], "tx", INT32_MIN, INT32_MAX);
  const std::int64_t y = parse_integer(request.captures[4], "ty", INT32_MIN, INT32_MAX);
  return {static_cast<std::uint32_t>(level), static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
}

/// Names what was asked for within one tile and revision; after a restart the operators may be others.
std::string representation(const PictureChoice& choice, Operators operators, std::string_view extension) {
  std::string name = choice.layer ? std::to_string(*choice.layer) : "fused";
  const std::array<int, 3> numbers{static_cast<int>(choice.style), static_cast<int>(choice.palette),
                                   static_cast<int>(operators)};
  for (const int number : numbers) name.append(".").append(std::to_string(number));
  return name.append(".").append(extension);
}

ApiResponse picture_of(ServedMap& map, Slot slot, const PictureChoice& choice) {
  ApiResponse response;
  response.content_type = "image/png";
  response.body = map.pictures().png(map.board(), slot, choice);
  response.etag =
      make_etag(map.epoch(), map.board().revision(slot), representation(choice, map.operators(), "png"));
  return response;
}

ApiResponse message_of(ServedMap& map, Slot slot, std::optional<int> layer, const ApiRequest& request) {
  const std::string_view planes = request.parameter("planes").value_or("evidence");
  if (planes != "value" && planes != "evidence") {
    throw RefusedRequest(400, "bad-parameter", "planes must be value or evidence", "planes");
  }
  TileChoice choice{{}, planes == "value" ? Planes::value : Planes::evidence};
  if (layer) choice.layers = {*layer};
  ApiResponse response;
  response.content_type = "application/x-protobuf";
  response.body = map.board().message(slot, choice);
  response.etag = make_etag(map.epoch(), map.board().revision(slot),
                            representation({layer, Style::visual, Palette::grey}, map.operators(), planes));
  return response;
}

ApiAnswer get_tile(const ApiRequest& request, ServerState& state) {
  ServedMap& map = requested_map(request, state);
  const auto layer = parse_layer(request.captures[1], map.board().info());
  const TileKey key = requested_key(request);
  const TileFormat format = requested_format(request);
  const PictureChoice choice = picture_choice(request, layer);
  const auto slot = map.board().find(key);
  ApiResponse response;
  if (!slot || !map.board().exists(*slot)) {
    response.status = 204;
  } else if (format == TileFormat::png) {
    response = picture_of(map, *slot, choice);
  } else if (format == TileFormat::protobuf) {
    response = message_of(map, *slot, layer, request);
  } else {
    const std::vector<int> layers = layer ? std::vector<int>{*layer} : std::vector<int>{};
    response = json_response(tile_json(map.board(), *slot, layers).dump());
    response.etag =
        make_etag(map.epoch(), map.board().revision(*slot), representation(choice, map.operators(), "json"));
  }
  response.cache_control = kLiveCache;
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

}  // namespace

std::vector<Route> tile_routes() {
  return {{Method::get, "/api/v1/maps/{}/layers/{}/tiles/{}/{}/{}", Role::view, get_tile}};
}

}  // namespace flogmap
