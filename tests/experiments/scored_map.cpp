#include "tests/experiments/scored_map.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/flog/distance_field.hpp"
#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_integrator.hpp"

namespace flogmap::experiments {
namespace {

constexpr Cell kFree{65535, 0, 65535, 0}, kOccupied{0, 65535, 65535, 0};

Cell fused_column(const Tile& tile, int column, const MapInfo& info) {
  bool free = false;
  for (int k = 0; k < info.grid.num_layers(); ++k) {
    const Cell& cell = tile.cells[std::size_t(k) * kTileColumns + std::size_t(column)];
    const CellClass answer = classify(Operators::algebraic, cell, info.min_rays);
    if (answer == CellClass::occupied) return kOccupied;
    free = free || answer == CellClass::free;
  }
  return free ? kFree : Cell{};
}

void add_where_set(Image<std::uint8_t>& sum, const Image<std::uint8_t>& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum.pixels[i] |= more.pixels[i];
}

/// Takes a group of touching cells away.
void remove_group(Image<std::uint8_t>& cells, int x, int y) {
  std::vector<std::pair<int, int>> open{{x, y}};
  while (!open.empty()) {
    const auto [cx, cy] = open.back();
    open.pop_back();
    if (!cells.contains(cx, cy) || cells.at(cx, cy) == 0) continue;
    cells.at(cx, cy) = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) open.emplace_back(cx + dx, cy + dy);
    }
  }
}

}  // namespace

MapSnapshot map_of(const Passage& passage, const std::vector<View>& views, const FlogOptions& options) {
  MapIntegrator integrator(options, passage.camera, passage.max_disparity_px);
  for (const View& view : views) integrator.integrate(view);
  return integrator.snapshot();
}

LayerScore score_of(const MapSnapshot& map, int layer, const LayerTruth& truth, const Trajectory& path,
                    int tolerance_cells) {
  ScoreOptions options;
  options.tolerance_cells = tolerance_cells;
  options.seen_surfaces = truth.seen_surfaces;
  for (const TimedPose& pose : path.poses) {
    options.path_m.emplace_back(pose.world_from_camera.translation().head<2>());
  }
  return score_layer(map, layer, truth.solid, options);
}

std::vector<LayerScore> scores_of(const MapSnapshot& map, const Passage& passage, int tolerance_cells) {
  std::vector<LayerScore> scores;
  for (std::size_t k = 0; k < passage.layers.size(); ++k) {
    scores.push_back(score_of(map, static_cast<int>(k), passage.layers[k], passage.truth, tolerance_cells));
  }
  return scores;
}

MapSnapshot fused(const MapSnapshot& map) {
  MapSnapshot one = map;
  one.info.grid.layer_bounds_m = {map.info.grid.layer_bounds_m.front(), map.info.grid.layer_bounds_m.back()};
  one.info.full_confidence_rays = {1};
  for (auto& [index, tile] : one.tiles) {
    auto flat = std::make_shared<Tile>();
    for (int column = 0; column < kTileColumns; ++column) {
      flat->cells.push_back(fused_column(*tile, column, map.info));
    }
    tile = flat;
  }
  return one;
}

LayerTruth fused(const std::vector<LayerTruth>& layers) {
  LayerTruth one = layers.front();
  one.high_m = layers.back().high_m;
  for (const LayerTruth& layer : layers) {
    add_where_set(one.solid.solid, layer.solid.solid);
    if (one.seen_surfaces) add_where_set(*one.seen_surfaces, *layer.seen_surfaces);
  }
  return one;
}

MapSnapshot with_threshold(MapSnapshot map, float threshold) {
  for (auto& [index, tile] : map.tiles) {
    auto answers = std::make_shared<Tile>(*tile);
    for (Cell& cell : answers->cells) {
      const bool occupied = map_value(Operators::algebraic, mu_E(cell), mu_O(cell), 1) >= threshold;
      cell = occupied ? Cell{0, 65535, cell.rays, 0} : Cell{65535, 0, cell.rays, 0};
    }
    tile = answers;
  }
  return map;
}

Spikes spikes_in(const MapSnapshot& map, int layer, const TruthLayer& truth, double away_m) {
  const Image<float> distance = distance_to_blocked(truth.solid);
  Image<std::uint8_t> cells(truth.solid.width, truth.solid.height, 0);
  Spikes spikes;
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) {
      if (distance.at(x, y) * truth.cell_size_m <= away_m) continue;
      const CellIndex cell = cell_at(map.info.grid, truth.origin_x_m + (x + 0.5) * truth.cell_size_m,
                                     truth.origin_y_m + (y + 0.5) * truth.cell_size_m);
      const CellClass answer = classify(Operators::algebraic, cell_in(map, cell, layer), map.info.min_rays);
      if (answer != CellClass::occupied) continue;
      cells.at(x, y) = 255;
      ++spikes.cells;
    }
  }
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) {
      if (cells.at(x, y) == 0) continue;
      remove_group(cells, x, y);
      ++spikes.groups;
    }
  }
  return spikes;
}

}  // namespace flogmap::experiments
