#include "server/overview.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flogmap {
namespace {

constexpr int kHalf = kTileSide / 2;

std::uint16_t to_membership(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * kMembershipScale));
}

/// Calls visit(column in the parent, first of the four columns in the child) for one child's quarter.
template <typename Visit>
void for_each_quarter_cell(int child, Visit visit) {
  const int x0 = (child & 1) * kHalf, y0 = (child >> 1) * kHalf;
  for (int y = 0; y < kHalf; ++y) {
    for (int x = 0; x < kHalf; ++x) {
      visit((y0 + y) * kTileSide + x0 + x, 2 * y * kTileSide + 2 * x);
    }
  }
}

}  // namespace

Cell overview_cell(const std::array<Cell, 4>& cells, float N_K) {
  float KE = std::numeric_limits<float>::infinity(), KO = 0, K = 0;
  std::uint16_t rays = 0, change = 0;
  for (const Cell& cell : cells) {
    const float K_i = confidence(cell, N_K);
    KE = std::min(KE, K_i * mu_E(cell));
    KO = std::max(KO, K_i * mu_O(cell));
    K = std::max(K, K_i);
    rays = std::max(rays, cell.rays);
    change = std::max(change, cell.change);
  }
  if (rays == 0) return {};
  const float most = std::min(std::ceil(N_K), 65535.0F);
  return {to_membership(KE / K), to_membership(KO / K), std::min(rays, static_cast<std::uint16_t>(most)),
          change};
}

Tile overview_tile(const ChildTiles& children, const MapInfo& info) {
  const int num_layers = info.grid.num_layers();
  Tile tile{TileCells(static_cast<std::size_t>(num_layers) * kTileColumns), 0};
  for (int child = 0; child < 4; ++child) {
    if (!children[child]) continue;
    tile.revision = std::max(tile.revision, children[child]->revision);
    for (int layer = 0; layer < num_layers; ++layer) {
      const Cell* from = children[child]->cells.data() + static_cast<std::size_t>(layer) * kTileColumns;
      Cell* to = tile.cells.data() + static_cast<std::size_t>(layer) * kTileColumns;
      const float N_K = info.full_confidence_rays[layer];
      for_each_quarter_cell(child, [&](int column, int below) {
        const Cell* row = from + below;
        to[column] = overview_cell({row[0], row[1], row[kTileSide], row[kTileSide + 1]}, N_K);
      });
    }
  }
  return tile;
}

PlaneBytes overview_value_plane(const std::array<const PlaneBytes*, 4>& children) {
  PlaneBytes plane(kTileColumns);
  for (int child = 0; child < 4; ++child) {
    if (!children[child] || children[child]->empty()) continue;
    const std::uint8_t* from = children[child]->data();
    for_each_quarter_cell(child, [&](int column, int below) {
      const std::uint8_t* row = from + below;
      plane[column] = std::max({row[0], row[1], row[kTileSide], row[kTileSide + 1]});
    });
  }
  return plane;
}

}  // namespace flogmap
