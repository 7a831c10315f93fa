// Views are added only when the camera has moved. What if all were?
#include <utility>

#include "tests/experiments/experiments.hpp"
#include "tests/experiments/map_drawing.hpp"
#include "tests/experiments/scored_map.hpp"
#include "tests/experiments/two_boxes_scenes.hpp"

namespace flogmap::experiments {
namespace {

constexpr const char* kQuestion =
    "A camera with a noisy sensor (3 grey levels) stands still for 100 frames and then circles the two "
    "boxes; true "
    "poses. A view is added when the camera has moved by 4 cells, or always. Views from one place repeat "
    "the same "
    "errors of the matcher, so they add confidence without adding knowledge (section 2.2 of the paper).";

constexpr int kStanding = 100;
constexpr WorldArea kAroundBoxes{-0.7, -0.5, 0.7, 0.5};

/// Mean confidence of all cells seen.
double mean_confidence(const MapSnapshot& map) {
  double sum = 0, seen = 0;
  for (const auto& [index, tile] : map.tiles) {
    for (const Cell& cell : tile->cells) {
      if (cell.rays < map.info.min_rays) continue;
      sum += confidence(cell, map.info.full_confidence_rays[0]), ++seen;
    }
  }
  return sum / seen;
}

/// Of the cells called occupied: more than 5 cm from every solid, and yet of full confidence.
int confidently_wrong(const MapSnapshot& map, const TruthLayer& truth) {
  MapSnapshot sure = map;
  sure.info.min_rays = static_cast<std::uint16_t>(map.info.full_confidence_rays[0]);
  return spikes_in(sure, 0, truth, 0.05).cells;
}

Passage standing_then_circling() {
  PassageOptions options = two_boxes_passage_options();
  options.with_odometry = false;
  options.every_frame = true;
  return pass_scene(two_boxes_after_standing(kStanding), options);
}

}  // namespace

Report repeated_views(Workshop& workshop) {
  Report report;
  report.title = "Only views from new places";
  report.question = kQuestion;
  const Passage passage = standing_then_circling();
  const auto first = passage.views.begin(), moving = first + kStanding;
  const std::pair<const char*, std::vector<View>> choices[] = {
      {"standing, the first view", {first, first + 1}},
      {"standing, every view", {first, moving}},
      {"then circling, moved only", {moving, passage.views.end()}},
      {"then circling, every view", passage.views}};
  Table table{
      {"views added", "number", "mean confidence K", "precision", "F1 occupied", "wrong at full confidence"},
      {}};
  std::vector<GreyImage> images;
  std::vector<double> K;
  std::vector<int> wrong;
  for (const auto& [name, views] : choices) {
    const MapSnapshot map = map_of(passage, views, two_boxes_options());
    const LayerScore score = scores_of(map, passage).front();
    K.push_back(mean_confidence(map));
    wrong.push_back(confidently_wrong(map, passage.layers[0].solid));
    table.rows.push_back({name, std::to_string(views.size()), text(K.back(), 2),
                          text(score.occupied.precision, 3), text(score.occupied.f1, 3),
                          std::to_string(wrong.back()) + " cells"});
    images.push_back(visual_map(map, kAroundBoxes, 0));
  }
  report.tables.push_back(std::move(table));
  write_beside(workshop.file("repeated-views.png"), images, 2);
  report.figures.push_back(
      {"repeated-views.png", "One view; a hundred from the same place; the circle; both"});
  report.findings = "A hundred views from one place raise the mean confidence from " + text(K[0], 2) +
                    " to " + text(K[1], 2) + " and the cells that are wrong with full confidence from " +
                    std::to_string(wrong[0]) + " to " + std::to_string(wrong[1]) +
                    ", though they show nothing that the first did not. Selecting views by motion is no cure "
                    "for a slow walk along "
                    "a wall, where views 4 cells apart share most of their errors too, and it throws away "
                    "what many views of a "
                    "noisy sensor could have averaged.";
  return report;
}

}  // namespace flogmap::experiments
