#include "mapping/flog/map_planes.hpp"

#include <algorithm>
#include <vector>

namespace flogmap {
namespace {

std::vector<int> layers_of(const MapInfo& info, std::optional<int> layer, const HeightRange& heights) {
  if (layer) return {*layer};
  std::vector<int> layers;
  for (int k = 0; k < info.grid.num_layers(); ++k) {
    if (meets(heights, info.grid, k)) layers.push_back(k);
  }
  return layers;
}

const Cell* cells_of(const Tile& tile, int layer) {
  return tile.cells.data() + std::size_t(layer) * kTileColumns;
}

std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(255.0F * value + 0.5F); }

std::uint8_t trinary(CellClass cell_class) {
  switch (cell_class) {
    case CellClass::occupied:
      return kTrinaryOccupied;
    case CellClass::free:
      return kTrinaryFree;
    case CellClass::unknown:
      break;
  }
  return kTrinaryUnknown;
}

}  // namespace

TilePlane value_plane(const Tile& tile, const MapInfo& info, std::optional<int> layer, const Rules& rules) {
  TilePlane plane(kTileSide, kTileSide, 0);
  for (const int k : layers_of(info, layer, rules.heights)) {
    const Cell* cells = cells_of(tile, k);
    const float N_K = info.full_confidence_rays[k];
    for (int i = 0; i < kTileColumns; ++i) {
      plane.pixels[i] = std::max(plane.pixels[i], to_byte(style_value(rules, cells[i], N_K)));
    }
  }
  return plane;
}

TilePlane trinary_plane(const Tile& tile, const MapInfo& info, std::optional<int> layer, const Rules& rules) {
  const std::vector<int> layers = layers_of(info, layer, rules.heights);
  TilePlane plane(kTileSide, kTileSide, layers.empty() ? kTrinaryUnknown : kTrinaryFree);
  for (const int k : layers) {
    const Cell* cells = cells_of(tile, k);
    for (int i = 0; i < kTileColumns; ++i) {
      const std::uint8_t here = trinary(classify(rules.operators, cells[i], info.min_rays));
      plane.pixels[i] = std::min(plane.pixels[i], here);  // occupied < unknown < free
    }
  }
  return plane;
}

std::uint8_t unseen_value(const MapInfo& info, const Rules& rules) {
  std::uint8_t value = 0;
  for (const int k : layers_of(info, std::nullopt, rules.heights)) {
    value = std::max(value, to_byte(style_value(rules, Cell{}, info.full_confidence_rays[k])));
  }
  return value;
}

}  // namespace flogmap
