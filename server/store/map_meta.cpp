#include "server/store/map_meta.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "server/store/checksum.hpp"
#include "server/store/map_schema.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::json;

std::int64_t text_checksum(std::string_view name, std::string_view value) {
  return static_cast<std::int64_t>(Sha256().add(name).add("=").add(value).number());
}

void write_text(const SqliteDatabase& database, std::string_view name, std::string_view value) {
  database.prepare("INSERT OR REPLACE INTO meta (name, value, checksum) VALUES (?, ?, ?)")
      .bind(1, name)
      .bind(2, value)
      .bind(3, text_checksum(name, value))
      .run();
}

std::string read_text(const SqliteDatabase& database, std::string_view name) {
  SqliteStatement row = database.prepare("SELECT value, checksum FROM meta WHERE name = ?");
  row.bind(1, name);
  if (!row.step()) throw damaged(database.file(), "meta '" + std::string(name) + "' is missing");
  std::string value(row.text(0));
  if (row.integer(1) != text_checksum(name, value) || !Json::accept(value)) {
    throw damaged(database.file(), "meta '" + std::string(name) + "' fails its checksum");
  }
  return value;
}

Json camera_json(const StereoCamera& camera) {
  return {{"focal_px", camera.focal_px},     {"cx_px", camera.cx_px},       {"cy_px", camera.cy_px},
          {"baseline_m", camera.baseline_m}, {"width_px", camera.width_px}, {"height_px", camera.height_px}};
}

StereoCamera camera_of(const Json& json) {
  return {json.at("focal_px"),   json.at("cx_px"),    json.at("cy_px"),
          json.at("baseline_m"), json.at("width_px"), json.at("height_px")};
}

StoredMap header_of(const Json& json) {
  StoredMap map;
  map.epoch = json.at("epoch");
  map.info.grid.cell_size_m = json.at("cell_size_m");
  map.info.grid.layer_bounds_m = json.at("layer_bounds_m").get<std::vector<double>>();
  map.info.full_confidence_rays = json.at("full_confidence_rays").get<std::vector<float>>();
  map.info.min_rays = json.at("min_rays");
  map.camera = camera_of(json.at("camera"));
  return map;
}

/// Files of before maps could be levelled have none.
HandLevel read_level(const SqliteDatabase& database) {
  if (database.integer("SELECT count(*) FROM meta WHERE name = 'level'") == 0) return {};
  const Json json = Json::parse(read_text(database, "level"));
  try {
    return {json.at("roll_rad"), json.at("pitch_rad"), json.at("yaw_rad"), json.at("height_m")};
  } catch (const Json::exception& error) {
    throw damaged(database.file(), std::string("meta 'level': ") + error.what());
  }
}

void check_camera(const StereoCamera& camera) {
  const std::array numbers{camera.focal_px, camera.cx_px, camera.cy_px, camera.baseline_m};
  const bool finite = std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
  if (!finite || camera.width_px < 0 || camera.height_px < 0) {
    throw std::invalid_argument("camera must be finite and of a size >= 0");
  }
}

}  // namespace

void check_header(const StoredMap& map) {
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (map.epoch.size() != 16 || !std::ranges::all_of(map.epoch, is_hex)) {
    throw std::invalid_argument("epoch must be 16 hex digits, got '" + map.epoch + "'");
  }
  check(map.info.grid);
  const auto& N_K = map.info.full_confidence_rays;
  const bool possible = std::ranges::all_of(N_K, [](float n) { return std::isfinite(n) && n >= 1; });
  if (static_cast<int>(N_K.size()) != map.info.grid.num_layers() || !possible) {
    throw std::invalid_argument("full_confidence_rays must hold one number >= 1 per layer");
  }
  check_camera(map.camera);
}

void write_header(const SqliteDatabase& database, const StoredMap& map) {
  check_header(map);
  const Json json{{"epoch", map.epoch},
                  {"cell_size_m", map.info.grid.cell_size_m},
                  {"layer_bounds_m", map.info.grid.layer_bounds_m},
                  {"full_confidence_rays", map.info.full_confidence_rays},
                  {"min_rays", map.info.min_rays},
                  {"camera", camera_json(map.camera)},
                  {"created_by", "flogmap " FLOGMAP_VERSION}};
  write_text(database, "map", json.dump());
  write_text(database, "options", map.options_json);
  write_text(database, "calibration", map.calibration_json);
  write_level(database, map.level);
}

void write_level(const SqliteDatabase& database, const HandLevel& level) {
  const Json json{{"roll_rad", level.roll_rad},
                  {"pitch_rad", level.pitch_rad},
                  {"yaw_rad", level.yaw_rad},
                  {"height_m", level.height_m}};
  write_text(database, "level", json.dump());
}

void write_seal(const SqliteDatabase& database, const MapSeal& seal) {
  const Json json{
      {"revision", seal.revision},   {"clean", seal.clean},         {"behind", seal.behind},
      {"num_tiles", seal.num_tiles}, {"tiles_sum", seal.tiles_sum}, {"num_poses", seal.num_poses},
      {"poses_sum", seal.poses_sum}, {"num_views", seal.num_views}, {"views_sum", seal.views_sum}};
  write_text(database, "seal", json.dump());
}

bool has_header(const SqliteDatabase& database) { return database.integer("SELECT count(*) FROM meta") > 0; }

StoredMap read_header(const SqliteDatabase& database) {
  const Json json = Json::parse(read_text(database, "map"));
  StoredMap map;
  try {
    map = header_of(json);
    check_header(map);
  } catch (const std::exception& error) {
    throw damaged(database.file(), std::string("meta 'map': ") + error.what());
  }
  map.options_json = read_text(database, "options");
  map.calibration_json = read_text(database, "calibration");
  map.level = read_level(database);
  return map;
}

MapSeal read_seal(const SqliteDatabase& database) {
  const Json json = Json::parse(read_text(database, "seal"));
  try {
    return {.revision = json.at("revision"),
            .num_tiles = json.at("num_tiles"),
            .tiles_sum = json.at("tiles_sum"),
            .num_poses = json.at("num_poses"),
            .poses_sum = json.at("poses_sum"),
            .num_views = json.at("num_views"),
            .views_sum = json.at("views_sum"),
            .clean = json.at("clean"),
            .behind = json.value("behind", false)};
  } catch (const Json::exception& error) {
    throw damaged(database.file(), std::string("meta 'seal': ") + error.what());
  }
}

}  // namespace flogmap
