#include "tests/server/contract_cases.hpp"

#include <algorithm>
#include <cctype>

namespace flogmap {
namespace {

const std::string kTile = kMap + "/layers/{layer}/tiles/{level}/{tx}/{ty}";

}  // namespace

std::string upper(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::toupper(c); });
  return word;
}

std::vector<Case> map_cases(const std::string& tile, const std::string& first_view) {
  const std::string live = "/api/v1/maps/live", tiles = live + "/layers/fused/tiles/";
  return {
      {"GET", "/api/v1/maps", "/api/v1/maps"},
      {"GET", kMap, live},
      {"GET", kMap, "/api/v1/maps/none", 404},
      {"GET", kTile, tiles + tile},
      {"GET", kTile, tiles + tile + "?style=motion&palette=cividis"},
      {"GET", kTile, tiles + tile + "?f=json"},
      {"GET",
       kTile,
       live + "/layers/0/tiles/" + tile + "?planes=value",
       200,
       {{"Accept", "application/x-protobuf"}}},
      {"GET", kTile, tiles + "0/99999/99999", 204},
      {"GET", kTile, tiles + "6/0/0", 400},
      {"GET", kTile, live + "/layers/77/tiles/0/0/0", 404},
      {"GET", kTile, tiles + tile, 406, {{"Accept", "image/gif"}}},
      {"GET", kMap + "/changes", live + "/changes?since=0&limit=10"},
      {"GET", kMap + "/changes", live + "/changes?limit=0", 400},
      {"GET", kMap + "/changes", live + "/changes?epoch=another", 409},
      {"GET", kMap + "/cell", live + "/cell?x=0.5&y=0.5"},
      {"GET", kMap + "/cell", live + "/cell?x=0.5", 400},
      {"GET", kMap + "/image.png", live + "/image.png?width=200"},
      {"GET", kMap + "/image.png", live + "/image.png?style=none", 400},
      {"GET", kMap + "/image.png", live + "/image.png?bbox=-1000,-1000,1000,1000", 422},
      {"GET", kMap + "/trajectory", live + "/trajectory"},
      {"GET", kMap + "/trajectory", live + "/trajectory?format=pb&from=1"},
      {"GET", kMap + "/trajectory", live + "/trajectory?format=kitti"},
      {"GET", kMap + "/trajectory", live + "/trajectory?format=no", 400},
      {"GET", kMap + "/trajectory", live + "/trajectory", 406, {{"Accept", "image/png"}}},
      {"GET", kMap + "/export", live + "/export?format=no", 400},
      {"GET", kMap + "/views", live + "/views"},
      {"GET", kMap + "/views", "/api/v1/maps/none/views", 404},
      {"GET", kMap + "/views/{n}.glb", live + "/views/" + first_view + ".glb"},
      {"GET", kMap + "/views/{n}.glb", live + "/views/123456789.glb", 404},
  };
}

std::vector<Case> posted_cases(const std::string& tile, const std::string& here) {
  const std::string live = "/api/v1/maps/live", x_y = tile.substr(2);
  const HttpHeaders as_json{{"Content-Type", kJson}};
  const HttpHeaders both_json{{"Content-Type", kJson}, {"Accept", kJson}};
  const std::string one_tile = R"({"tiles":[{"level":0,"x":)" + x_y.substr(0, x_y.find('/')) + R"(,"y":)" +
                               x_y.substr(x_y.find('/') + 1) + "}]}";
  std::vector<Case> cases{
      {"POST", kMap + "/tiles:batchGet", live + "/tiles:batchGet", 200, as_json, one_tile},
      {"POST", kMap + "/tiles:batchGet", live + "/tiles:batchGet", 200, both_json, one_tile},
      {"POST", kMap + "/route", live + "/route", 200, as_json,
       R"({"from":)" + here + R"(,"to":)" + here + R"(,"robot_radius_m":0.05})"},
      {"POST", kMap + "/reachable", live + "/reachable", 200, as_json,
       R"({"from":)" + here + R"(,"robot_radius_m":0.05})"},
  };
  for (const std::string name : {"/tiles:batchGet", "/route", "/reachable"}) {
    cases.push_back({"POST", kMap + name, live + name, 400, as_json, "{"});
    cases.push_back({"POST", kMap + name, live + name, 415, {{"Content-Type", "text/plain"}}, "{}"});
    cases.push_back({"POST", kMap + name, live + name, 422, as_json, "{}"});
  }
  return cases;
}

std::vector<Case> session_cases() {
  const HttpHeaders as_json{{"Content-Type", kJson}};
  const std::string playback = "/api/v1/playback", session = "/api/v1/session";
  const std::string left = "/api/v1/frames/{stream}/latest";
  return {
      {"GET", "/api/v1/stream", "/api/v1/stream", 400},
      {"GET", session, session},
      {"POST", session + ":pause", session + ":pause", 409},
      {"GET", playback, playback},
      {"PATCH", playback, playback, 200, as_json, R"({"rate":0})"},
      {"PATCH", playback, playback, 415, {{"Content-Type", "text/plain"}}, "{}"},
      {"PATCH", playback, playback, 422, as_json, R"({"rate":"fast"})"},
      {"POST", playback + ":step", playback + ":step"},
      {"POST", session + ":resume", session + ":resume"},
      {"POST", session + ":resume", session + ":resume", 409},
      {"POST", playback + ":step", playback + ":step", 409},
      {"POST", session + ":pause", session + ":pause"},
      {"GET", left, "/api/v1/frames/left/latest"},
      {"GET", left, "/api/v1/frames/disparity/latest?max_width=100"},
      {"GET", left, "/api/v1/frames/up/latest", 404},
      {"GET", "/api/v1/config", "/api/v1/config"},
      {"GET", "/api/v1/calibration", "/api/v1/calibration"},
      {"GET", "/api/v1/version", "/api/v1/version"},
      {"GET", "/api/v1/calibrate", "/api/v1/calibrate", 404},
      {"GET", "/api/v1/calibrate/{side}", "/api/v1/calibrate/left", 404},
      {"POST", "/api/v1/calibrate:solve", "/api/v1/calibrate:solve", 404},
      {"POST", "/api/v1/calibrate:restart", "/api/v1/calibrate:restart", 404},
      {"GET", "/healthz", "/healthz"},
      {"GET", "/readyz", "/readyz"},
      {"GET", "/metrics", "/metrics"},
      {"GET", "/openapi.yaml", "/openapi.yaml"},
      {"GET", "/docs", "/docs"},
      {"POST", "/api/v1/login", "/api/v1/login", 200, as_json, R"({"token":"view-secret"})"},
      {"POST", "/api/v1/login", "/api/v1/login", 401, as_json, R"({"token":"wrong-secret"})"},
      {"POST", "/api/v1/logout", "/api/v1/logout"},
      {"POST", session + ":level", session + ":level", 200, as_json, R"({"roll_deg":2,"height_m":-0.1})"},
      {"POST", session + ":level", session + ":level", 415, {{"Content-Type", "text/plain"}}, "{}"},
      {"POST", session + ":level", session + ":level", 422, as_json, R"({"pitch_deg":181})"},
      {"POST", session + ":level", session + ":level", 422, as_json, R"({"tilt":1})"},
      {"POST", session + ":reset", session + ":reset"},
  };
}

}  // namespace flogmap
