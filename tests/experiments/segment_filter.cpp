// What small patches of wrong disparity do to a map, and what is left of it when they are removed.
#include "tests/experiments/segment_filter.hpp"

#include <algorithm>
#include <cmath>

#include "camera/simulation/scene_json.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/map_drawing.hpp"
#include "tests/experiments/two_boxes_scenes.hpp"

namespace flogmap::experiments {
namespace {

constexpr const char* kQuestion =
    "Two boxes from near with a noisy sensor (4 grey levels), true poses, with and without removing "
    "patches smaller "
    "than 0.15 % of the picture (section 1.3 of the paper: nearly all spikes go). Each wrong patch of a "
    "view is a spike "
    "in what that view says; spikes of the map are groups of occupied cells more than 5 cm from every "
    "solid, after all "
    "33 views have had their say.";

constexpr WorldArea kCircle{-1.5, -1.5, 1.5, 1.5};

struct Patch {
  std::int64_t pixels = 0, wrong = 0;
};

/// Takes the patch at (x, y) out of `left` and counts it.
Patch take_patch(Image<float>& left, const Image<float>& exact, int x, int y) {
  Patch patch;
  std::vector<std::pair<int, int>> open{{x, y}};
  const auto take = [&](int px, int py) {
    ++patch.pixels;
    patch.wrong += std::abs(left.at(px, py) - exact.at(px, py)) > 1 ? 1 : 0;
  };
  std::vector<float> before{left.at(x, y)};
  take(x, y);
  left.at(x, y) = std::nanf("");
  while (!open.empty()) {
    const auto [cx, cy] = open.back();
    const float d = before.back();
    open.pop_back(), before.pop_back();
    for (const auto& [nx, ny] : {std::pair{cx + 1, cy}, {cx - 1, cy}, {cx, cy + 1}, {cx, cy - 1}}) {
      if (!left.contains(nx, ny) || !(std::abs(left.at(nx, ny) - d) <= 1)) continue;
      take(nx, ny);
      open.emplace_back(nx, ny), before.push_back(left.at(nx, ny));
      left.at(nx, ny) = std::nanf("");
    }
  }
  return patch;
}

std::string times_fewer(std::int64_t off, std::int64_t on) {
  return text(static_cast<double>(off) / static_cast<double>(std::max<std::int64_t>(1, on)), 1);
}

}  // namespace

WrongPatches wrong_patches(const DisparityImage& measured, const DisparityImage& exact) {
  Image<float> left = measured.px;
  WrongPatches sum;
  for (int y = 0; y < left.height; ++y) {
    for (int x = 0; x < left.width; ++x) {
      if (!(left.at(x, y) > 0)) continue;
      const Patch patch = take_patch(left, exact.px, x, y);
      if (2 * patch.wrong <= patch.pixels) continue;
      ++sum.patches;
      sum.pixels += patch.pixels;
    }
  }
  return sum;
}

FilterOutcome map_with_filter(MatcherKind matcher, double min_segment_fraction) {
  Scene scene = load_scene("two-boxes-near");
  scene.sensor.noise_grey = 4;
  PassageOptions options = two_boxes_passage_options();
  options.with_odometry = false;
  options.keep_exact = true;
  options.stereo.matcher = matcher;
  options.stereo.min_segment_fraction = min_segment_fraction;
  const Passage passage = pass_scene(scene, options);
  FilterOutcome outcome{map_of(passage, passage.views, two_boxes_options()), {}, {}, 0};
  for (std::size_t i = 0; i < passage.views.size(); ++i) {
    const WrongPatches more = wrong_patches(passage.views[i].disparity, passage.exact[i]);
    outcome.in_views.patches += more.patches, outcome.in_views.pixels += more.pixels;
  }
  outcome.in_map = spikes_in(outcome.map, 0, passage.layers[0].solid, 0.05);
  outcome.occupied_f1 = mean_occupied_f1(scores_of(outcome.map, passage));
  return outcome;
}

Report segment_filter(Workshop& workshop) {
  Report report;
  report.title = "The segmentation filter";
  report.question = kQuestion;
  Table table{{"matcher", "filter", "spikes in the views", "pixels in them", "spikes in the map",
               "cells in them", "F1 occupied"},
              {}};
  std::vector<GreyImage> images;
  std::vector<FilterOutcome> outcomes;
  for (const MatcherKind matcher : {MatcherKind::block, MatcherKind::sgm}) {
    for (const double fraction : {0.0, StereoOptions{}.min_segment_fraction}) {
      outcomes.push_back(map_with_filter(matcher, fraction));
      const FilterOutcome& o = outcomes.back();
      table.rows.push_back(
          {matcher == MatcherKind::block ? "block (SMW5, the paper's)" : "semi-global (default)",
           fraction > 0 ? "on" : "off", std::to_string(o.in_views.patches), std::to_string(o.in_views.pixels),
           std::to_string(o.in_map.groups), std::to_string(o.in_map.cells), text(o.occupied_f1, 3)});
      images.push_back(trinary_map(o.map, kCircle, 0));
    }
  }
  report.tables.push_back(std::move(table));
  write_beside(workshop.file("segment-filter.png"), images, 1);
  report.figures.push_back(
      {"segment-filter.png", "Block matching without and with the filter, semi-global likewise"});
  report.findings = "The filter removes all but one in " +
                    times_fewer(outcomes[0].in_views.patches, outcomes[1].in_views.patches) +
                    " spikes of block matching and one in " +
                    times_fewer(outcomes[2].in_views.patches, outcomes[3].in_views.patches) +
                    " of semi-global matching before they reach the map. In the map itself the difference is "
                    "smaller (cells: one in " +
                    times_fewer(outcomes[0].in_map.cells, outcomes[1].in_map.cells) + " and " +
                    times_fewer(outcomes[2].in_map.cells, outcomes[3].in_map.cells) +
                    "), since views that overlap outvote each other's spikes and large wrong patches, mostly "
                    "veils beside outlines, pass "
                    "the filter; and true small things go with the wrong ones.";
  return report;
}

}  // namespace flogmap::experiments
