#include "server/commands/evaluate_map.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "mapping/map_truth.hpp"
#include "server/commands/continued_map.hpp"
#include "server/map_store.hpp"
#include "server/option_table.hpp"

namespace flogmap {
namespace {

using nlohmann::json;

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
    return load_settled_map(file);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

LayerTruth load_truth(const std::string& folder, int layer) {
  try {
    return read_layer_truth(folder, layer);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

LayerScore score(const StoredMap& map, const std::string& folder, int layer, int tolerance_cells) {
  const LayerTruth truth = load_truth(folder, layer);
  ScoreOptions options;
  options.tolerance_cells = tolerance_cells;
  options.seen_surfaces = truth.seen_surfaces;
  for (const TrajectoryEntry& entry : map.trajectory) {
    options.path_m.emplace_back(entry.world_from_camera.translation().head<2>());
  }
  return score_layer(snapshot_of(map), layer, truth.solid, options);
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
