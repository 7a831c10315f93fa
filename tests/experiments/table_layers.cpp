// Three layers against one tall one, and against many: obstacles, and the free space under a table.
#include "mapping/flog/map_area.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/map_drawing.hpp"
#include "tests/experiments/scored_map.hpp"

namespace flogmap::experiments {
namespace {

constexpr const char* kQuestion =
    "A table (top from 0.72 to 0.76 m, a cardboard box on it) circled by a hand-held camera, true poses, "
    "heights "
    "0.05 to 1.5 m cut into layers in four ways. Fused: a column is occupied if any layer is. Scored "
    "against the "
    "truth of all heights together; \"free under the table\" is the share of the ground between its legs "
    "that the "
    "lowest layer calls free.";

constexpr WorldArea kRoom{-2.8, -2.6, 2.8, 2.6};

/// Share of the ground between the table's legs that a layer calls free.
double free_under_table(const MapSnapshot& map, int layer) {
  const CellIndex low = cell_at(map.info.grid, -0.66, -0.31), high = cell_at(map.info.grid, 0.66, 0.31);
  double free = 0, all = 0;
  for (CellIndex cell{0, low.y}; cell.y < high.y; ++cell.y) {
    for (cell.x = low.x; cell.x < high.x; ++cell.x, ++all) {
      const CellClass answer = classify(Operators::algebraic, cell_in(map, cell, layer), map.info.min_rays);
      free += answer == CellClass::free ? 1 : 0;
    }
  }
  return free / all;
}

std::vector<double> even_layers(double low_m, double high_m, int count) {
  std::vector<double> bounds;
  for (int i = 0; i <= count; ++i) bounds.push_back(low_m + (high_m - low_m) * i / count);
  return bounds;
}

struct Choice {
  const char* name;
  std::vector<double> bounds_m;
};

std::vector<Choice> choices() {
  return {{"one of 1.45 m", {0.05, 1.5}},
          {"three even ones", even_layers(0.05, 1.5, 3)},
          {"three: below, top, above", {0.05, 0.7, 0.78, 1.5}},
          {"fifteen even ones", even_layers(0.05, 1.5, 15)}};
}

}  // namespace

Report table_layers(Workshop& workshop) {
  Report report;
  report.title = "Layers fused against one tall layer";
  report.question = kQuestion;
  const Passage& passage = *workshop.passage("table");
  const std::vector<View> views = at_true_poses(passage);
  const LayerTruth truth = fused(passage.layers);
  Table table{{"layers", "F1 of obstacles, fused", "precision", "recall", "free under the table"}, {}};
  std::vector<GreyImage> images{true_map(truth.solid, kRoom)};
  std::vector<double> f1, recall;
  for (const Choice& choice : choices()) {
    FlogOptions options;
    options.grid.layer_bounds_m = choice.bounds_m;
    const MapSnapshot map = map_of(passage, views, options), one = fused(map);
    const LayerScore score = score_of(one, 0, truth, passage.truth);
    f1.push_back(score.occupied.f1);
    recall.push_back(score.occupied.recall);
    table.rows.push_back({std::string(choice.name), text(score.occupied.f1, 3),
                          text(score.occupied.precision, 3), text(recall.back(), 3),
                          percent(free_under_table(map, 0), 0)});
    images.push_back(trinary_map(one, kRoom, 0));
  }
  report.tables.push_back(std::move(table));
  write_beside(workshop.file("table-layers.png"), images, 1);
  report.figures.push_back(
      {"table-layers.png", "Truth; one layer, three even, three fitted, fifteen (grey: unknown)"});
  report.findings =
      "Three layers fitted to the table find " + percent(recall[2], 0) +
      " of the surfaces seen and still know that one can "
      "roll under it; one tall layer averages the top away with the free space above and below it (recall " +
      percent(recall[0], 0) + "). Layers of even height do hardly better than one (" + percent(recall[1], 0) +
      "): what fills a small part of its layer's height loses against the rays that pass above it, and "
      "fifteen thin layers "
      "buy " +
      percent(recall[3], 0) + " with memory and with false obstacles, F1 " + text(f1[3], 3) + ".";
  return report;
}

}  // namespace flogmap::experiments
