// Every row of a view, or every n-th: what the map loses, what time it saves.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_integrator.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/line_chart.hpp"
#include "tests/experiments/scored_map.hpp"

namespace flogmap::experiments {
namespace {

struct TimedMap {
  MapSnapshot map;
  double median_ms = 0;
};

TimedMap timed_map(const Passage& passage, const std::vector<View>& views, int row_step) {
  FlogOptions options;
  options.row_step = row_step;
  options.num_threads = 1;
  MapIntegrator integrator(options, passage.camera, passage.max_disparity_px);
  std::vector<double> times_ms;
  for (const View& view : views) {
    const auto start = std::chrono::steady_clock::now();
    integrator.integrate(view);
    times_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times_ms.begin(), times_ms.begin() + times_ms.size() / 2, times_ms.end());
  return {integrator.snapshot(), times_ms[times_ms.size() / 2]};
}

struct Difference {
  double mean_value = 0;   // of |M - M'| with K = 1, over cells seen by both
  double other_class = 0;  // share of the cells seen in either that are called otherwise
};

Difference difference(const MapSnapshot& a, const MapSnapshot& b) {
  double seen_by_both = 0, seen = 0;
  Difference sum;
  const int min_rays = a.info.min_rays;
  for (const auto& [index, tile] : a.tiles) {
    const auto other = b.tiles.find(index);
    for (std::size_t i = 0; i < tile->cells.size(); ++i) {
      const Cell& x = tile->cells[i];
      const Cell y = other == b.tiles.end() ? Cell{} : other->second->cells[i];
      if (x.rays < min_rays && y.rays < min_rays) continue;
      ++seen;
      sum.other_class +=
          classify(Operators::algebraic, x, min_rays) != classify(Operators::algebraic, y, min_rays);
      if (x.rays < min_rays || y.rays < min_rays) continue;
      ++seen_by_both;
      sum.mean_value += std::abs(map_value(Operators::algebraic, mu_E(x), mu_O(x), 1) -
                                 map_value(Operators::algebraic, mu_E(y), mu_O(y), 1));
    }
  }
  return {sum.mean_value / seen_by_both, sum.other_class / seen};
}

}  // namespace

Report row_steps(Workshop& workshop) {
  Report report;
  report.title = "Every n-th row";
  report.question =
      "corridor-loop at 640x480 with true poses, using every n-th row of a view. The paper uses every second "
      "to save "
      "time. Time per view: median, one thread, 20 mm cells, three layers; it depends on the machine.";
  const Passage& passage = *workshop.passage("corridor-loop");
  const std::vector<View> views = at_true_poses(passage);
  Table table{
      {"rows", "time per view", "mean change of M", "cells called otherwise", "F1 occupied", "coverage"}, {}};
  Series time{"time per view [ms]", {}};
  const TimedMap all = timed_map(passage, views, 1);
  Difference of_second;
  for (const int n : {1, 2, 4, 8, 16}) {
    const TimedMap some = timed_map(passage, views, n);
    const Difference d = difference(all.map, some.map);
    if (n == 2) of_second = d;
    const auto scores = scores_of(some.map, passage);
    table.rows.push_back({"every " + std::to_string(n), text(some.median_ms, 1) + " ms",
                          text(d.mean_value, 4), percent(d.other_class, 2), text(mean_occupied_f1(scores), 3),
                          text(mean_of(scores, [](const LayerScore& s) { return s.coverage; }), 3)});
    time.points.emplace_back(n, some.median_ms);
  }
  report.tables.push_back(std::move(table));
  write_chart(workshop.file("row-steps.svg"),
              {"Time to map a view", "every n-th row", "median [ms]", {time}});
  report.figures.push_back({"row-steps.svg", "Time per view against n"});
  report.findings = "Every second row changes the map value by " + text(of_second.mean_value, 4) +
                    " on average and the call of " + percent(of_second.other_class, 2) +
                    " of the cells, and F1 does not care even about every sixteenth. It saves less time than "
                    "rows, because the fan pays "
                    "for the columns of each azimuth whatever the number of its rays, and what goes first "
                    "are far cells and thin things "
                    "that fall below 8 rays, which the mean over a room hides.";
  return report;
}

}  // namespace flogmap::experiments
