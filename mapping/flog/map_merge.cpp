#include "mapping/flog/map_merge.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "mapping/flog/cell_fuse.hpp"
#include "mapping/flog/map_area.hpp"

namespace flogmap {
namespace {

void check_same_kind(const MapSnapshot& a, const MapSnapshot& b) {
  if (a.info.grid.cell_size_m != b.info.grid.cell_size_m) {
    throw std::runtime_error("merge: cell_size_m differs: " + std::to_string(a.info.grid.cell_size_m) +
                             " and " + std::to_string(b.info.grid.cell_size_m));
  }
  if (a.info.grid.layer_bounds_m != b.info.grid.layer_bounds_m) {
    throw std::runtime_error("merge: layer_bounds_m differ");
  }
}

/// From a's columns to b's.
class Placement {
 public:
  Placement(const MapPlacement& b_in_a, const GridSpec& grid)
      : grid_(grid), placement_(b_in_a), cosine_(std::cos(b_in_a.yaw_rad)), sine_(std::sin(b_in_a.yaw_rad)) {}

  /// Four points of a column of a, as columns of b.
  [[nodiscard]] std::array<CellIndex, 4> columns_of_b(CellIndex in_a) const {
    std::array<CellIndex, 4> columns;
    for (int i = 0; i < 4; ++i) {
      const double a = grid_.cell_size_m;
      const double x = (in_a.x + (i % 2 == 0 ? 0.25 : 0.75)) * a - placement_.x_m;
      const double y = (in_a.y + (i < 2 ? 0.25 : 0.75)) * a - placement_.y_m;
      columns[i] = cell_at(grid_, cosine_ * x + sine_ * y, -sine_ * x + cosine_ * y);
    }
    return columns;
  }

  /// Tiles of a that a tile of b may touch.
  [[nodiscard]] std::set<TileIndex> tiles_of_a(TileIndex in_b) const {
    const double side = kTileSide * grid_.cell_size_m;
    std::set<TileIndex> tiles;
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; j <= 8;
           ++j) {  // every eighth of a tile, so that no corner cut is missed by more than that
        const double x = (in_b.x + i / 8.0) * side, y = (in_b.y + j / 8.0) * side;
        const CellIndex cell = cell_at(grid_, cosine_ * x - sine_ * y + placement_.x_m,
                                       sine_ * x + cosine_ * y + placement_.y_m);
        for (const int dx : {-8, 8}) {
          for (const int dy : {-8, 8}) tiles.insert(tile_of({cell.x + dx, cell.y + dy}));
        }
      }
    }
    return tiles;
  }

 private:
  const GridSpec& grid_;
  MapPlacement placement_;
  double cosine_, sine_;
};

/// Adds to a cell what b says at four points; `worth` is N_K of a over N_K of b.
void add(Cell& cell, const MapSnapshot& b, const std::array<CellIndex, 4>& columns, int layer, double worth,
         double N_f) {
  double N = cell.rays, NE = N * mu_E(cell), NO = N * mu_O(cell);
  double change = cell.change;
  for (const CellIndex column : columns) {
    const Cell other = cell_in(b, column, layer);
    const double rays = other.rays * worth / 4;
    N += rays;
    NE += rays * mu_E(other);
    NO += rays * mu_O(other);
    change = std::max(change, double{1} * other.change);
  }
  if (N < 0.5) return;
  cell.empty = static_cast<std::uint16_t>(std::lround(NE / N * kMembershipScale));
  const auto occupied = static_cast<std::uint16_t>(std::lround(NO / N * kMembershipScale));
  cell.occupied = std::min(occupied, static_cast<std::uint16_t>(65535 - cell.empty));
  cell.rays = static_cast<std::uint16_t>(std::lround(std::min(N, N_f)));
  cell.change = static_cast<std::uint16_t>(change);
}

}  // namespace

MapSnapshot merge_maps(const MapSnapshot& a, const MapSnapshot& b, const MapPlacement& b_in_a) {
  check_same_kind(a, b);
  MapSnapshot merged = a;
  merged.revision = a.revision + 1;
  const GridSpec& grid = a.info.grid;
  const Placement placement(b_in_a, grid);
  std::set<TileIndex> touched;
  for (const auto& [index, tile] : b.tiles) touched.merge(placement.tiles_of_a(index));
  for (const TileIndex index : touched) {
    const auto old = a.tiles.find(index);
    auto tile = old != a.tiles.end() ? std::make_shared<Tile>(*old->second) : std::make_shared<Tile>();
    tile->cells.resize(std::size_t(grid.num_layers()) * kTileColumns);
    const TileCells before = tile->cells;
    for (int i = 0; i < kTileColumns; ++i) {
      const CellIndex first = first_cell(index);
      const auto columns = placement.columns_of_b({first.x + (i & kTileMask), first.y + (i >> kTileShift)});
      for (int k = 0; k < grid.num_layers(); ++k) {
        const double N_K = a.info.full_confidence_rays[k];
        add(tile->cells[std::size_t(k) * kTileColumns + i], b, columns, k,
            N_K / b.info.full_confidence_rays[k], max_rays(N_K));
      }
    }
    if (tile->cells == before) continue;
    tile->revision = merged.revision;
    merged.tiles[index] = tile;
  }
  return merged;
}

}  // namespace flogmap
