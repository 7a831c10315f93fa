#include "server/cell_inspection.hpp"

#include <cmath>

namespace flogmap {
namespace {

CellEvidence evidence_of(const Cell& cell, int layer, float N_K, Operators operators) {
  const float E = mu_E(cell), O = mu_O(cell), K = confidence(cell, N_K);
  CellEvidence out;
  out.layer = layer;
  out.empty = static_cast<double>(E);
  out.occupied = static_cast<double>(O);
  out.confidence = static_cast<double>(K);
  out.rays = cell.rays;
  out.value = static_cast<double>(map_value(operators, E, O, K));
  out.planning = static_cast<double>(planning_value(operators, O, K));
  out.motion = static_cast<double>(motion_value(operators, E, O, K));
  out.conflict = static_cast<double>(conflict_value(E, O, K));
  out.change = static_cast<double>(static_cast<float>(cell.change) / kMembershipScale);
  return out;
}

}  // namespace

bool has_cell(const GridSpec& grid, double x_m, double y_m) {
  constexpr double kMostCells = 2147483000.0;
  const double most_m = kMostCells * grid.cell_size_m;
  return std::isfinite(x_m) && std::isfinite(y_m) && std::abs(x_m) < most_m && std::abs(y_m) < most_m;
}

CellColumn inspect_cell(ServedMap& map, double x_m, double y_m) {
  const MapInfo& info = map.board().info();
  CellColumn column{x_m, y_m, map.epoch(), 0, {}};
  if (!has_cell(info.grid, x_m, y_m)) return column;
  const CellIndex cell = cell_at(info.grid, x_m, y_m);
  const auto tile = map.board().tiles().find(tile_of(cell));
  const bool seen = tile != map.board().tiles().end();
  if (seen) column.revision = tile->second->revision;
  for (int layer = 0; layer < info.grid.num_layers(); ++layer) {
    const std::size_t at = static_cast<std::size_t>(layer) * kTileColumns + column_in_tile(cell);
    const Cell evidence = seen ? tile->second->cells[at] : Cell{};
    column.layers.push_back(
        evidence_of(evidence, layer, info.full_confidence_rays[layer], map.board().operators()));
  }
  return column;
}

}  // namespace flogmap
