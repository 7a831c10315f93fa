// Space above and below the layers does not get into the map.
#include "camera/simulation/scene_json.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/map_drawing.hpp"
#include "tests/experiments/scored_map.hpp"
#include "tests/experiments/two_boxes_scenes.hpp"

namespace flogmap::experiments {
namespace {

constexpr const char* kQuestion =
    "A look down on the boxes of moving-box from 1.1 m, where floor and furniture fill the view: one layer "
    "with and "
    "without what is below and above the boxes, scored against the truth of [0.05, 0.75) m. The paper: "
    "layers keep "
    "out what does not matter to a robot of their height.";

constexpr WorldArea kCircle{-1.2, -1.2, 1.2, 1.2};

struct Heights {
  double low_m, high_m;
  const char* name;
};

}  // namespace

Report layer_heights(Workshop& workshop) {
  Report report;
  report.title = "Space above and below is excluded by the layer";
  report.question = kQuestion;
  PassageOptions options;
  options.with_odometry = false;
  options.max_frames = 250;  // one round
  Scene scene = load_scene("moving-box");
  scene.truth.layer_bounds_m = {0.05, 0.75};
  const Passage passage = pass_scene(scene, options);
  Table table{{"layer", "F1 occupied", "free cells wrongly blocked", "coverage"}, {}};
  std::vector<GreyImage> images{true_map(passage.layers[0].solid, kCircle)};
  std::vector<LayerScore> scores;
  for (const Heights& heights :
       {Heights{0.05, 0.75, "5 cm above the floor to 75 cm"}, Heights{0.0, 0.75, "from the floor itself"},
        Heights{-0.3, 0.75, "the floor within"}, Heights{-0.3, 2.8, "everything"}}) {
    FlogOptions flog;
    flog.grid.layer_bounds_m = {heights.low_m, heights.high_m};
    const MapSnapshot map = map_of(passage, passage.views, flog);
    scores.push_back(score_of(map, 0, passage.layers[0], passage.truth));
    table.rows.push_back({std::string(heights.name), text(scores.back().occupied.f1, 3),
                          percent(scores.back().wrongly_blocked), text(scores.back().coverage, 3)});
    images.push_back(visual_map(map, kCircle, 0, true));
  }
  report.tables.push_back(std::move(table));
  write_beside(workshop.file("layer-heights.png"), images, 1);
  report.figures.push_back(
      {"layer-heights.png", "The truth; layers from 5 cm, from the floor, with the floor, of all"});
  report.findings = "A layer that starts 5 cm above the floor scores F1 " + text(scores[0].occupied.f1, 3) +
                    " and one of all heights " + text(scores[3].occupied.f1, 3) +
                    ": the more that does not matter is in a layer, the paler the boxes, while the floor "
                    "alone does little harm, since "
                    "the rays that pass above it outvote those that end on it. The price is that what is "
                    "lower than the layer (a "
                    "threshold, a shoe) is not in the map at all, and with the start at 5 cm one degree of "
                    "unknown tilt brings the floor "
                    "back at three metres.";
  return report;
}

}  // namespace flogmap::experiments
