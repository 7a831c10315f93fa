// N_f lets a map forget: how many views until a box that was taken away is gone?
#include <algorithm>
#include <cmath>

#include "camera/simulation/scene_json.hpp"
#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_integrator.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/line_chart.hpp"
#include "tests/experiments/scored_map.hpp"

namespace flogmap::experiments {
namespace {

constexpr const char* kQuestion =
    "moving-box: after one round around three boxes one of them is taken away and another is pushed; true "
    "poses. N_f = "
    "3 N_K is what bounds a cell's memory. Gone: less than a tenth of the box's cells are still called "
    "occupied. "
    "The count is of mapped views, all of them looking at the place.";

constexpr double kRemovedAt_s = 26;  // in scene moving-box
constexpr int kNever = -1;

struct Fading {
  Series share;  // of the box's cells that are still occupied, against views since
  int views_until_gone = kNever;
  double f1_at_end = 0;
};

/// Cells of the lowest layer within the removed box's surroundings that are called occupied.
std::vector<CellIndex> box_cells(const MapSnapshot& map) {
  std::vector<CellIndex> cells;
  const CellIndex low = cell_at(map.info.grid, 0.1, -0.45), high = cell_at(map.info.grid, 0.7, 0.15);
  for (CellIndex cell{0, low.y}; cell.y < high.y; ++cell.y) {
    for (cell.x = low.x; cell.x < high.x; ++cell.x) {
      const CellClass answer = classify(Operators::algebraic, cell_in(map, cell, 0), map.info.min_rays);
      if (answer == CellClass::occupied) cells.push_back(cell);
    }
  }
  return cells;
}

double still_occupied(const MapSnapshot& map, const std::vector<CellIndex>& cells) {
  const auto count = std::count_if(cells.begin(), cells.end(), [&](CellIndex cell) {
    return classify(Operators::algebraic, cell_in(map, cell, 0), map.info.min_rays) == CellClass::occupied;
  });
  return static_cast<double>(count) / std::max<double>(1, static_cast<double>(cells.size()));
}

Fading fading(const Passage& passage, double full_confidence_rays) {
  FlogOptions options;
  options.grid.layer_bounds_m = {0.05, 0.75, 1.45};
  options.full_confidence_rays = full_confidence_rays;
  MapIntegrator integrator(options, passage.camera, passage.max_disparity_px);
  const std::int64_t start_ns = passage.truth.poses.front().timestamp_ns;
  std::vector<CellIndex> cells;
  Fading fading;
  int since = 0;
  for (const View& view : passage.views) {
    if (1e-9 * static_cast<double>(view.timestamp_ns - start_ns) >= kRemovedAt_s) {
      if (since++ == 0) cells = box_cells(integrator.snapshot());
    }
    integrator.integrate(view);
    if (since == 0) continue;
    const double share = still_occupied(integrator.snapshot(), cells);
    fading.share.points.emplace_back(since, share);
    if (share < 0.1 && fading.views_until_gone == kNever) fading.views_until_gone = since;
  }
  fading.f1_at_end = mean_occupied_f1(scores_of(integrator.snapshot(), passage));
  return fading;
}

}  // namespace

Report removed_box(Workshop& workshop) {
  Report report;
  report.title = "Forgetting: N_f and a box that was taken away";
  report.question = kQuestion;
  PassageOptions options;
  options.with_odometry = false;
  Passage passage = pass_scene(load_scene("moving-box"), options);
  const double derived =
      MapIntegrator({}, passage.camera, passage.max_disparity_px).info().full_confidence_rays.front();
  Table table{{"N_K", "N_f", "views until gone", "F1 occupied at the end"}, {}};
  LineChart chart{"A box that was taken away", "views since", "share of its cells still occupied", {}};
  std::vector<Fading> all;
  for (const double share : {0.0625, 0.25, 1.0, 4.0}) {
    const double N_K = std::round(share * derived);
    all.push_back(fading(passage, N_K));
    Fading& one = all.back();
    one.share.name = "N_K = " + text(N_K, 0);
    table.rows.push_back({text(N_K, 0) + (share == 1 ? " (derived)" : ""),
                          text(std::min(3 * N_K, 65535.0), 0),
                          one.views_until_gone == kNever ? "never" : std::to_string(one.views_until_gone),
                          text(one.f1_at_end, 3)});
    chart.series.push_back(one.share);
  }
  report.tables.push_back(std::move(table));
  write_chart(workshop.file("removed-box.svg"), chart);
  report.figures.push_back({"removed-box.svg", "Share of the removed box's cells still called occupied"});
  const Fading& as_derived = all[2];
  report.findings =
      "With the derived N_K the box is gone after " +
      (as_derived.views_until_gone == kNever ? "more views than there are"
                                             : std::to_string(as_derived.views_until_gone) + " views") +
      ", and a smaller N_f forgets sooner, as it should. It forgets true things just as fast: a cell's "
      "memory is "
      "counted in rays, not in places or time, so that a camera close to a thing overwrites within a few "
      "views what it "
      "learnt from a whole round, right or wrong.";
  return report;
}

}  // namespace flogmap::experiments
