#include "server/export/octomap_map.hpp"

#include <octomap/OcTree.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace flogmap {
namespace {

constexpr int kKeyOfOrigin = 1 << 15;  // OctoMap's keys are 16 bits, the origin in the middle

std::uint16_t key_of(std::int64_t cube, double side_m) {
  const std::int64_t key = cube + kKeyOfOrigin;
  if (key < 0 || key >= 2 * kKeyOfOrigin) {
    throw std::runtime_error("the map reaches " + std::to_string(static_cast<double>(cube) * side_m) +
                             " m from the origin; an OctoMap tree with such cells ends at " +
                             std::to_string(kKeyOfOrigin * side_m) + " m");
  }
  return static_cast<std::uint16_t>(key);
}

/// Cubes whose middle lies in [low, high).
struct CubeRange {
  std::int64_t first, end;
};

CubeRange cubes_between(double low_m, double high_m, double side_m) {
  const auto first_from = [&](double z_m) {
    return static_cast<std::int64_t>(std::ceil(z_m / side_m - 0.5 - 1e-9));
  };
  return {first_from(low_m), first_from(high_m)};
}

void fill_column(octomap::OcTree& tree, CellIndex index, CubeRange cubes, bool occupied, double side_m) {
  const float log_odds = occupied ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog();
  const std::uint16_t x = key_of(index.x, side_m), y = key_of(index.y, side_m);
  for (std::int64_t z = cubes.first; z < cubes.end; ++z) {
    tree.setNodeValue(octomap::OcTreeKey(x, y, key_of(z, side_m)), log_odds, true);
  }
}

void fill_tile(octomap::OcTree& tree, const StoredMap& map, const TileUpdate& update, Operators operators) {
  const GridSpec& grid = map.info.grid;
  const CellIndex corner = first_cell(update.index);
  for (std::size_t i = 0; i < update.tile->cells.size(); ++i) {
    const CellClass cell = classify(operators, update.tile->cells[i], map.info.min_rays);
    if (cell == CellClass::unknown) continue;
    const std::size_t layer = i / kTileColumns;
    const int column = static_cast<int>(i % kTileColumns);
    const CellIndex index{corner.x + (column & kTileMask), corner.y + (column >> kTileShift)};
    const double low_m = grid.layer_bounds_m[layer], high_m = grid.layer_bounds_m[layer + 1];
    fill_column(tree, index, cubes_between(low_m, high_m, grid.cell_size_m), cell == CellClass::occupied,
                grid.cell_size_m);
  }
}

}  // namespace

std::string octomap_of(const StoredMap& map, Operators operators) {
  octomap::OcTree tree(map.info.grid.cell_size_m);
  for (const TileUpdate& update : map.tiles) fill_tile(tree, map, update, operators);
  tree.updateInnerOccupancy();
  tree.toMaxLikelihood();
  tree.prune();
  // As OcTree::writeBinary() writes it, which also talks on stderr.
  std::ostringstream bytes;
  bytes << "# Octomap OcTree binary file\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
        << tree.getResolution() << "\ndata\n";
  if (!tree.writeBinaryData(bytes)) throw std::runtime_error("OctoMap cannot write the tree");
  return bytes.str();
}

}  // namespace flogmap
