// The classical alternative to compare with: an occupancy grid of log-odds, after H. P. Moravec and A. Elfes,
// "High Resolution Maps from Wide Angle Sonar", ICRA 1985, and A. Elfes, "Using Occupancy Grids for Mobile
// Robot Perception and Navigation", IEEE Computer 22(6), 1989. Every ray is taken as independent of every
// other.
#pragma once

#include <map>
#include <vector>

#include "mapping/flog/flog_options.hpp"
#include "mapping/flog/ray_model.hpp"
#include "mapping/tile_update.hpp"
#include "mapping/view.hpp"

namespace flogmap::experiments {

struct BayesOptions {
  double log_odds_hit = 0.85;   // added where a ray ends: an occupancy of 0.7
  double log_odds_miss = -0.4;  // added where it passes: an occupancy of 0.4
};

/// Same grid, same rays, same widths as the FLOG map; cell by cell along every ray.
class BayesGrid {
 public:
  BayesGrid(const FlogOptions& flog, const StereoCamera& camera, const BayesOptions& options);

  void add(const View& view);

  /// Probability that a cell is occupied; 0.5 where nothing is known.
  [[nodiscard]] double probability(CellIndex cell, int layer) const;

  /// Cells with 8 rays or more are occupied if their probability is `threshold` or more, else free. The
  /// answers stand in a map of FLOG cells, so that both are scored and drawn alike.
  [[nodiscard]] MapSnapshot as_map(double threshold) const;

  /// Calls visit(cell, layer, log-odds, rays) for every cell with a ray.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (const auto& [index, tile] : tiles_) {
      for (std::size_t i = 0; i < tile.size(); ++i) {
        if (tile[i].rays == 0) continue;
        const int column = static_cast<int>(i) % kTileColumns;
        const CellIndex first = first_cell(index);
        visit(CellIndex{first.x + (column & kTileMask), first.y + (column >> kTileShift)},
              static_cast<int>(i) / kTileColumns, tile[i].log_odds, tile[i].rays);
      }
    }
  }

 private:
  struct BayesCell {
    double log_odds = 0;
    int rays = 0;
  };
  std::vector<BayesCell>& tile_at(TileIndex index);

  FlogOptions flog_;
  RayModel model_;
  BayesOptions options_;
  std::map<TileIndex, std::vector<BayesCell>> tiles_;  // [layer * 4096 + column_in_tile]
};

}  // namespace flogmap::experiments
