#include "tests/experiments/two_boxes_scenes.hpp"

#include "camera/simulation/scene_json.hpp"

namespace flogmap::experiments {

FlogOptions two_boxes_options() {
  FlogOptions options;
  options.grid = {0.01, {0.0, 0.42}};
  options.max_range_m = kTwoBoxesRange_m;
  return options;
}

PassageOptions two_boxes_passage_options() {
  PassageOptions options;
  options.view_translation_m = 0.04;
  options.reach_m = kTwoBoxesRange_m;
  return options;
}

Scene two_boxes_from(double distance_m) {
  Scene scene = load_scene("two-boxes-near");
  for (PathPoint& point : scene.path.points) {
    point.position_m.head<2>() *= distance_m / point.position_m.head<2>().norm();
  }
  return scene;
}

Scene two_boxes_after_standing(int num_frames) {
  Scene scene = load_scene("two-boxes-near");
  scene.sensor.noise_grey = 3;
  scene.path.points.insert(scene.path.points.begin(), num_frames, scene.path.points.front());
  scene.num_frames += num_frames;
  return scene;
}

std::array<Side, 3> open_sides() {
  return {Side{{-0.35, 0.11}, {-0.05, 0.11}}, Side{{-0.05, -0.11}, {-0.35, -0.11}},
          Side{{-0.35, -0.11}, {-0.35, 0.11}}};
}

Side hidden_side() { return {{-0.05, 0.11}, {-0.05, -0.11}}; }

}  // namespace flogmap::experiments
