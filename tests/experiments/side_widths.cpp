// How thick a box side stands in the map, against distance.
#include "mapping/flog/membership.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/line_chart.hpp"
#include "tests/experiments/scored_map.hpp"
#include "tests/experiments/two_boxes_scenes.hpp"

namespace flogmap::experiments {
namespace {

constexpr double kDepthOfSide_m = 0.13;  // sides stand this much nearer than the boxes' middle, on average

struct Width {
  double distance_m, measured_m, predicted_m;
};

Width width_at(double distance_m) {
  PassageOptions options = two_boxes_passage_options();
  options.with_odometry = false;
  const Passage passage = pass_scene(two_boxes_from(distance_m), options);
  FlogOptions flog = two_boxes_options();
  flog.max_range_m = distance_m + 0.6;
  const MapSnapshot map = map_of(passage, passage.views, flog);
  double sum = 0;
  for (const Side& side : open_sides()) sum += profile_of(map, 0, side).width_m;
  const double l = distance_m - kDepthOfSide_m;
  const RangeError error = range_error(passage.camera, flog.grid.cell_size_m, false);
  return {distance_m, sum / 3, membership_width(error, l, l)};
}

}  // namespace

Report side_widths(Workshop& workshop) {
  Report report;
  report.title = "How thick a side is, against distance";
  report.question =
      "The same circle from six distances, with true poses: the width of the left box's three open sides at half "
      "the peak of the map value, beside 3 delta_l of eq. (5), which is the width at half maximum of the triangle "
      "of eq. (7) for a ray that meets the side at a right angle (never less than a cell). The paper's pictures show "
      "about 20 mm at 1.1 m and 40-50 mm at 1.8 m.";
  Table table{{"distance", "measured", "3 delta_l"}, {}};
  Series measured{"measured", {}}, predicted{"3 delta_l, eq. (5)", {}};
  std::vector<Width> widths;
  for (const double distance_m : {0.9, 1.1, 1.4, 1.8, 2.2, 2.6}) {
    widths.push_back(width_at(distance_m));
    const Width& width = widths.back();
    table.rows.push_back({text(distance_m, 1) + " m", text(1000 * width.measured_m, 1) + " mm",
                          text(1000 * width.predicted_m, 1) + " mm"});
    measured.points.emplace_back(distance_m, 1000 * width.measured_m);
    predicted.points.emplace_back(distance_m, 1000 * width.predicted_m);
  }
  report.tables.push_back(std::move(table));
  write_chart(workshop.file("side-width.svg"), {"Width of a box side", "distance from the middle [m]",
                                                "width at half maximum [mm]", {measured, predicted}});
  report.figures.push_back({"side-width.svg", "Width of a box side against distance"});
  report.findings =
      "From 1.1 to 1.8 m the sides grow by a factor of " + text(widths[3].measured_m / widths[1].measured_m, 2) +
      ", roughly with the square of the distance, as eq. (5) says. They are thicker than eq. (5) alone: oblique rays "
      "and errors of the matcher at outlines, which the method takes for the same 0.1 px as everything else, add to "
      "it, and cells of 10 mm cannot show less than about two of them.";
  return report;
}

}  // namespace flogmap::experiments
