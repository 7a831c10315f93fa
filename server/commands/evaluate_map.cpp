#include "server/commands/evaluate_map.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

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

void print_table(const std::vector<LayerScore>& scores) {
  std::printf("        occupied               free\n");
  std::printf("layer   precis recall     F1   precis recall     F1   coverage  wrong.block  wrong.free\n");
  for (std::size_t k = 0; k < scores.size(); ++k) print_row(static_cast<int>(k), scores[k]);
}

void print_json(const std::vector<LayerScore>& scores) {
  json document = json::array();
  for (const LayerScore& s : scores) {
    document.push_back({{"layer", document.size()},
                        {"occupied", to_json(s.occupied)},
                        {"free", to_json(s.free)},
                        {"coverage", s.coverage},
                        {"wrongly_blocked", s.wrongly_blocked},
                        {"wrongly_free", s.wrongly_free}});
  }
  std::printf("%s\n", document.dump(2).c_str());
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

/// A truth of other heights tells nothing about the map's layer.
void check_heights(const GridSpec& grid, const LayerTruth& truth, const std::string& folder, int layer) {
  constexpr double kTolerance_m = 0.001;
  const double low = grid.layer_bounds_m[layer], high = grid.layer_bounds_m[layer + 1];
  const bool said = truth.low_m != 0 || truth.high_m != 0;
  const bool same =
      std::abs(truth.low_m - low) <= kTolerance_m && std::abs(truth.high_m - high) <= kTolerance_m;
  if (!said || same) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "z is %g to %g m, but layer %d of the map is %g to %g m; map with the --layers of the truth",
                truth.low_m, truth.high_m, layer, low, high);
  throw UsageError(folder + "/layer_" + std::to_string(layer) + ".json: " + text);
}

LayerScore score(const StoredMap& map, const std::string& folder, int layer, int tolerance_cells) {
  const LayerTruth truth = load_truth(folder, layer);
  check_heights(map.info.grid, truth, folder, layer);
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
  std::vector<LayerScore> scores;  // all of them before the first is printed
  for (int layer = 0; layer < map.info.grid.num_layers(); ++layer)
    scores.push_back(score(map, truth_folder, layer, tolerance_cells));
  if (as_json) {
    print_json(scores);
  } else {
    print_table(scores);
  }
}

}  // namespace flogmap
