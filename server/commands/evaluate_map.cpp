#include "server/commands/evaluate_map.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "camera/picture_files.hpp"
#include "mapping/flog/map_score.hpp"
#include "server/map_store.hpp"
#include "server/option_table.hpp"

namespace flogmap {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

Image<std::uint8_t> read_mask(const fs::path& file) {
  const ReadPicture read = read_picture(file);
  if (!read.problem.empty()) throw UsageError(read.problem);
  if (read.picture.channels != 1 || read.picture.bits != 8) {
    throw UsageError(file.string() + ": must be a grey picture with 8 bits");
  }
  Image<std::uint8_t> mask(read.picture.width, read.picture.height);
  mask.pixels = read.picture.bytes;
  return mask;
}

/// What the JSON beside a truth image says.
struct TruthDescription {
  double origin_x_m = 0, origin_y_m = 0;
  double cell_size_m = 0;
};

TruthDescription read_description(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw UsageError(file.string() + ": cannot be read");
  try {
    const json document = json::parse(in);
    const auto origin = document.at("origin").get<std::vector<double>>();
    const double cell_size_m = document.at("cell").get<double>();
    if (origin.size() != 2) throw UsageError(file.string() + ": origin must be [x, y] in metres");
    if (!(cell_size_m > 0))
      throw UsageError(file.string() + ": cell must be > 0 m, is " + document["cell"].dump());
    return {origin[0], origin[1], cell_size_m};
  } catch (const json::exception& error) {
    throw UsageError(file.string() + ": " + error.what() + "; needs origin [x, y] and cell, metres");
  }
}

json to_json(const ClassScore& score) {
  return {{"precision", score.precision}, {"recall", score.recall}, {"f1", score.f1}};
}

void print_row(int layer, const LayerScore& s) {
  std::printf("%5d   %6.3f %6.3f %6.3f   %6.3f %6.3f %6.3f   %8.3f %12.3f %10.3f\n", layer,
              s.occupied.precision, s.occupied.recall, s.occupied.f1, s.free.precision, s.free.recall,
              s.free.f1, s.coverage, s.wrongly_blocked, s.wrongly_free);
}

StoredMap load_input(const std::string& file) {
  try {
    return load_map(file);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

LayerScore score(const StoredMap& map, const fs::path& folder, int layer, int tolerance_cells) {
  const std::string name = "layer_" + std::to_string(layer);
  const TruthDescription description = read_description(folder / (name + ".json"));
  TruthLayer truth;
  truth.solid = read_mask(folder / (name + ".png"));
  truth.origin_x_m = description.origin_x_m;
  truth.origin_y_m = description.origin_y_m;
  truth.cell_size_m = description.cell_size_m;
  ScoreOptions options;
  options.tolerance_cells = tolerance_cells;
  for (const TrajectoryEntry& entry : map.trajectory) {
    options.path_m.emplace_back(entry.world_from_camera.translation().head<2>());
  }
  const fs::path seen = folder / ("seen_" + std::to_string(layer) + ".png");
  if (fs::exists(seen)) options.could_be_seen = read_mask(seen);
  return score_layer(snapshot_of(map), layer, truth, options);
}

}  // namespace

void evaluate_map(const std::string& map_file, const std::string& truth_folder, int tolerance_cells,
                  bool as_json) {
  const StoredMap map = load_input(map_file);
  json document = json::array();
  if (!as_json) {
    std::printf("        occupied               free\n");
    std::printf("layer   precis recall     F1   precis recall     F1   coverage  wrong.block  wrong.free\n");
  }
  for (int layer = 0; layer < map.info.grid.num_layers(); ++layer) {
    const LayerScore s = score(map, truth_folder, layer, tolerance_cells);
    document.push_back({{"layer", layer},
                        {"occupied", to_json(s.occupied)},
                        {"free", to_json(s.free)},
                        {"coverage", s.coverage},
                        {"wrongly_blocked", s.wrongly_blocked},
                        {"wrongly_free", s.wrongly_free}});
    if (!as_json) print_row(layer, s);
  }
  if (as_json) std::printf("%s\n", document.dump(2).c_str());
}

}  // namespace flogmap
