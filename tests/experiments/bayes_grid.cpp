#include "tests/experiments/bayes_grid.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/flog/grazing.hpp"

namespace flogmap::experiments {

BayesGrid::BayesGrid(const FlogOptions& flog, const StereoCamera& camera, const BayesOptions& options)
    : flog_(flog), model_(ray_model(flog, camera)), options_(options) {}

std::vector<BayesGrid::BayesCell>& BayesGrid::tile_at(TileIndex index) {
  std::vector<BayesCell>& tile = tiles_[index];
  if (tile.empty()) tile.resize(std::size_t(flog_.grid.num_layers()) * kTileColumns);
  return tile;
}

void BayesGrid::add(const View& view) {
  const DisparityImage seen = without_grazing(model_.camera, flog_.grid, view, flog_.max_incidence_deg);
  const Image<float>& d = seen.px;
  for (int y = 0; y < d.height; y += flog_.row_step) {
    for (int x = 0; x < d.width; x += flog_.column_step) {
      const auto measured = measured_ray(model_, view.world_from_camera, x, y, d.at(x, y));
      if (!measured) continue;
      TileIndex at{};
      std::vector<BayesCell>* tile = nullptr;
      for_each_cell(flog_.grid, measured->ray, [&](const Chord& chord) {
        const TileIndex index = tile_of(chord.column);
        if (tile == nullptr || index != at) tile = &tile_at(at = index);
        const double r = chord.nearest_m;
        BayesCell& cell = (*tile)[std::size_t(chord.layer) * kTileColumns + column_in_tile(chord.column)];
        cell.log_odds += options_.log_odds_hit * mu_O(r, measured->l, measured->m) +
                         options_.log_odds_miss * mu_E(r, measured->l, measured->m);
        ++cell.rays;
      });
    }
  }
}

double BayesGrid::probability(CellIndex cell, int layer) const {
  const auto tile = tiles_.find(tile_of(cell));
  if (tile == tiles_.end()) return 0.5;
  const double odds = tile->second[std::size_t(layer) * kTileColumns + column_in_tile(cell)].log_odds;
  return 1 / (1 + std::exp(-odds));
}

MapSnapshot BayesGrid::as_map(double threshold) const {
  MapSnapshot map;
  map.info.grid = flog_.grid;
  map.info.min_rays = static_cast<std::uint16_t>(flog_.min_rays);
  map.info.full_confidence_rays.assign(flog_.grid.num_layers(), 1.0F);
  const double odds = std::log(threshold / (1 - threshold));
  for (const auto& [index, cells] : tiles_) {
    auto tile = std::make_shared<Tile>();
    for (const BayesCell& cell : cells) {
      const auto rays = static_cast<std::uint16_t>(std::min(cell.rays, 65535));
      const bool occupied = cell.log_odds >= odds;
      tile->cells.push_back(occupied ? Cell{0, 65535, rays, 0} : Cell{65535, 0, rays, 0});
    }
    map.tiles[index] = std::move(tile);
  }
  return map;
}

}  // namespace flogmap::experiments
