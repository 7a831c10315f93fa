// FLOG against a Bayesian log-odds grid: the same rays, the same cells.
#include <algorithm>
#include <cmath>

#include "mapping/flog/distance_field.hpp"
#include "mapping/flog/map_area.hpp"
#include "tests/experiments/bayes_grid.hpp"
#include "tests/experiments/experiments.hpp"
#include "tests/experiments/line_chart.hpp"
#include "tests/experiments/map_drawing.hpp"
#include "tests/experiments/scored_map.hpp"

namespace flogmap::experiments {
namespace {

constexpr double kSure = 0.99;  // a probability, or a degree, that leaves no doubt

FlogOptions thinned() {
  FlogOptions options;
  options.row_step = options.column_step = 2;  // ray by ray takes its time
  return options;
}

std::vector<std::string> score_row(const std::string& name, const MapSnapshot& map, const Passage& passage) {
  const auto scores = scores_of(map, passage);
  const auto mean = [&](auto figure) { return text(mean_of(scores, figure), 3); };
  return {name, mean([](const LayerScore& s) { return s.occupied.precision; }),
          mean([](const LayerScore& s) { return s.occupied.recall; }),
          mean([](const LayerScore& s) { return s.occupied.f1; }),
          mean([](const LayerScore& s) { return s.free.f1; })};
}

/// Cells that FLOG calls contradictory, and what the probabilities say of the same cells.
struct Doubt {
  int contradictory = 0;
  int sure = 0;       // of these: p < 0.01 or p > 0.99
  int near_half = 0;  // of these: 0.4 < p < 0.6
};

Doubt doubt(const MapSnapshot& flog, const BayesGrid& bayes) {
  Doubt doubt;
  for (const auto& [index, tile] : flog.tiles) {
    for (std::size_t i = 0; i < tile->cells.size(); ++i) {
      const Cell& cell = tile->cells[i];
      if (cell.rays < 50 || std::min(mu_E(cell), mu_O(cell)) < 0.3F) continue;
      const int column = static_cast<int>(i) % kTileColumns;
      const CellIndex first = first_cell(index);
      const double p = bayes.probability({first.x + (column & kTileMask), first.y + (column >> kTileShift)},
                                         static_cast<int>(i) / kTileColumns);
      ++doubt.contradictory;
      doubt.sure += p < 1 - kSure || p > kSure ? 1 : 0;
      doubt.near_half += p > 0.4 && p < 0.6 ? 1 : 0;
    }
  }
  return doubt;
}

/// Cells more than 5 cm from any solid of which a map is sure that they are occupied.
int surely_wrong(const MapSnapshot& answers, const Passage& passage) {
  int cells = 0;
  for (int k = 0; k < static_cast<int>(passage.layers.size()); ++k) {
    cells += spikes_in(answers, k, passage.layers[k].solid, 0.05).cells;
  }
  return cells;
}

/// What the findings quote.
struct Outcome {
  double flog_occupied = 0, flog_free = 0, bayes_occupied = 0, bayes_free = 0;
  double sure_share = 0;  // of contradictory cells that the probabilities are sure of
  int repeated = 0, bayes_wrong = 0, flog_wrong = 0;
};

Outcome add_scores(Report& report, const Passage& passage, const std::vector<View>& views,
                   Workshop& workshop) {
  const MapSnapshot flog = map_of(passage, views, thinned());
  BayesGrid bayes(thinned(), passage.camera, {});
  for (const View& view : views) bayes.add(view);
  Table table{{"map", "precision", "recall", "F1 occupied", "F1 free"}, {}};
  table.rows.push_back(score_row("FLOG, M >= 0.3", flog, passage));
  for (const float threshold : {0.4F, 0.5F}) {
    table.rows.push_back(
        score_row("FLOG, M >= " + text(threshold, 1), with_threshold(flog, threshold), passage));
  }
  for (const double threshold : {1e-12, 0.01, 0.5, 0.99, 1 - 1e-12}) {
    const std::string name = threshold < 1e-6     ? "1e-12"
                             : threshold > 0.9999 ? "1 - 1e-12"
                                                  : text(threshold, 2);
    table.rows.push_back(score_row("log-odds, p >= " + name, bayes.as_map(threshold), passage));
  }
  const Doubt d = doubt(flog, bayes);
  const double n = std::max(1, d.contradictory);
  Table doubts{{"cells with 50 rays or more and both E and O >= 0.3", "of these p < 0.01 or p > 0.99",
                "of these 0.4 < p < 0.6"},
               {{std::to_string(d.contradictory), percent(d.sure / n), percent(d.near_half / n)}}};
  report.tables = {std::move(table), std::move(doubts)};
  const TruthLayer& truth = passage.layers[0].solid;
  const WorldArea area{truth.origin_x_m, truth.origin_y_m,
                       truth.origin_x_m + truth.solid.width * truth.cell_size_m,
                       truth.origin_y_m + truth.solid.height * truth.cell_size_m};
  write_beside(workshop.file("bayes-flog.png"),
               {trinary_map(flog, area, 0), trinary_map(bayes.as_map(0.5), area, 0)}, 1);
  report.figures.push_back({"bayes-flog.png", "Lowest layer: FLOG, log-odds at p = 0.5 (grey: unknown)"});
  const auto flog_scores = scores_of(flog, passage), bayes_scores = scores_of(bayes.as_map(0.5), passage);
  return {mean_occupied_f1(flog_scores), mean_free_f1(flog_scores), mean_occupied_f1(bayes_scores),
          mean_free_f1(bayes_scores), d.sure / n};
}

/// One view added again and again: how many cells each map is sure of, and wrong.
void add_repetition(Report& report, const Passage& passage, const View& view, Workshop& workshop,
                    Outcome& outcome) {
  Series flog_wrong{"FLOG, M >= 0.99", {}}, bayes_wrong{"log-odds, p >= 0.99", {}};
  BayesGrid bayes(thinned(), passage.camera, {});
  std::vector<View> views;
  Table table{{"times the same view", "log-odds: sure and wrong", "FLOG: sure and wrong"}, {}};
  int done = 0;
  for (const int times : {1, 2, 4, 8, 16, 32}) {
    for (; done < times; ++done) bayes.add(view), views.push_back(view);
    const MapSnapshot flog = map_of(passage, views, thinned());
    const int wrong_bayes = surely_wrong(bayes.as_map(kSure), passage);
    const int wrong_flog = surely_wrong(with_threshold(flog, static_cast<float>(kSure)), passage);
    table.rows.push_back({std::to_string(times), std::to_string(wrong_bayes), std::to_string(wrong_flog)});
    outcome.repeated = times, outcome.bayes_wrong = wrong_bayes, outcome.flog_wrong = wrong_flog;
    bayes_wrong.points.emplace_back(times, wrong_bayes);
    flog_wrong.points.emplace_back(times, wrong_flog);
  }
  report.tables.push_back(std::move(table));
  write_chart(
      workshop.file("bayes-repeated.svg"),
      {"The same view again and again", "times added", "cells sure and wrong", {bayes_wrong, flog_wrong}});
  report.figures.push_back({"bayes-repeated.svg", "Cells of which a map is sure although it is wrong"});
}

std::string findings(const Outcome& o) {
  return "FLOG finds obstacles better (F1 " + text(o.flog_occupied, 3) + " against " +
         text(o.bayes_occupied, 3) +
         " at p = 0.5), keeps what is contradictory apart from what is unknown where the probabilities are "
         "sure of " +
         percent(o.sure_share, 0) + " of the very same cells, and after " + std::to_string(o.repeated) +
         " repetitions of one view is surely wrong in " + std::to_string(o.flog_wrong) +
         " of its cells against " + std::to_string(o.bayes_wrong) +
         ". The log-odds grid is better at free space (F1 " + text(o.bayes_free, 3) + " against " +
         text(o.flog_free, 3) +
         "), draws sharper walls, and with a threshold far from 0.5 comes close on obstacles too: that its "
         "numbers are no "
         "probabilities does not keep them from sorting cells well.";
}

}  // namespace

Report bayesian_grid(Workshop& workshop) {
  Report report;
  report.title = "FLOG against a Bayesian grid";
  report.question =
      "The same views of corridor-loop (true poses, every second row and column), the same cells, layers and "
      "widths, "
      "added ray by ray as log-odds (0.7 where a ray ends, 0.4 where it passes, in between by eqs. (6) and "
      "(7); no "
      "clamping) after Moravec and Elfes. First the scores at several thresholds; then cells in which both "
      "maps have "
      "evidence for both answers; then one view added again and again, as a camera that stands still would, "
      "and how "
      "many cells more than 5 cm from any solid are then surely occupied (p or M of 0.99 or more).";
  const Passage& passage = *workshop.passage("corridor-loop");
  const std::vector<View> views = at_true_poses(passage);
  Outcome outcome = add_scores(report, passage, views, workshop);
  add_repetition(report, passage, views[views.size() / 2], workshop, outcome);
  report.findings = findings(outcome);
  return report;
}

}  // namespace flogmap::experiments
