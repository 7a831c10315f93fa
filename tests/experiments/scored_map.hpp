// Maps of a passage's views, and how right they are.
#pragma once

#include <string>
#include <vector>

#include "mapping/flog/flog_options.hpp"
#include "mapping/flog/map_score.hpp"
#include "mapping/tile_update.hpp"
#include "tests/experiments/passage.hpp"

namespace flogmap::experiments {

/// The views in order, in a map of their own.
[[nodiscard]] MapSnapshot map_of(const Passage& passage, const std::vector<View>& views,
                                 const FlogOptions& options);

/// Of every layer of the truth, within `tolerance_cells` of it.
[[nodiscard]] std::vector<LayerScore> scores_of(const MapSnapshot& map, const Passage& passage,
                                                int tolerance_cells = 2);

/// Of one layer.
[[nodiscard]] LayerScore score_of(const MapSnapshot& map, int layer, const LayerTruth& truth,
                                  const Trajectory& path, int tolerance_cells = 2);

/// Mean over layers of what `figure` takes from a score.
template <typename Figure>
double mean_of(const std::vector<LayerScore>& scores, const Figure& figure) {
  double sum = 0;
  for (const LayerScore& score : scores) sum += figure(score);
  return scores.empty() ? 0 : sum / static_cast<double>(scores.size());
}

inline double mean_occupied_f1(const std::vector<LayerScore>& scores) {
  return mean_of(scores, [](const LayerScore& score) { return score.occupied.f1; });
}
inline double mean_free_f1(const std::vector<LayerScore>& scores) {
  return mean_of(scores, [](const LayerScore& score) { return score.free.f1; });
}

/// Occupied where any layer is, else free where any is: one layer of plain answers, with the truth likewise.
[[nodiscard]] MapSnapshot fused(const MapSnapshot& map);
[[nodiscard]] LayerTruth fused(const std::vector<LayerTruth>& layers);

/// The same map with plain answers: occupied where the map value with full confidence is `threshold` or more.
[[nodiscard]] MapSnapshot with_threshold(MapSnapshot map, float threshold);

/// Occupied cells in truly free space more than `away_m` from any solid of the truth.
struct Spikes {
  int cells = 0;
  int groups = 0;  // of cells that touch, corners included
};
[[nodiscard]] Spikes spikes_in(const MapSnapshot& map, int layer, const TruthLayer& truth, double away_m);

}  // namespace flogmap::experiments
