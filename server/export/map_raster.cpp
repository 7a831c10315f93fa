#include "server/export/map_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace flogmap {
namespace {

constexpr std::int64_t kMaxColumns = std::int64_t{1} << 28;

/// Corners of what was seen; empty while low > high.
struct Bounds {
  std::int64_t low_x = std::numeric_limits<std::int64_t>::max(), low_y = low_x;
  std::int64_t high_x = std::numeric_limits<std::int64_t>::min(), high_y = high_x;

  void add(std::int64_t x, std::int64_t y) {
    low_x = std::min(low_x, x);
    low_y = std::min(low_y, y);
    high_x = std::max(high_x, x);
    high_y = std::max(high_y, y);
  }
};

void add_tile(const TileUpdate& update, Bounds& bounds) {
  const CellIndex first = first_cell(update.index);
  const auto& cells = update.tile->cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].rays == 0) continue;
    const int column = static_cast<int>(i % kTileColumns);
    bounds.add(std::int64_t{first.x} + (column & kTileMask), std::int64_t{first.y} + (column >> kTileShift));
  }
}

/// Calls visit(cell, layer, pixel) for every cell of the chosen layers with a ray in it, inside the window.
template <typename T, typename Visit>
void for_each_seen(const StoredMap& map, const MapWindow& window, LayerChoice layer, Image<T>& image,
                   const Visit& visit) {
  const int first_layer = layer.value_or(0);
  const int last_layer = layer.value_or(map.info.grid.num_layers() - 1);
  for (const TileUpdate& update : map.tiles) {
    const CellIndex corner = first_cell(update.index);
    for (int k = first_layer; k <= last_layer; ++k) {
      const Cell* plane = update.tile->cells.data() + static_cast<std::size_t>(k) * kTileColumns;
      for (int column = 0; column < kTileColumns; ++column) {
        if (plane[column].rays == 0) continue;
        const int x = corner.x + (column & kTileMask) - window.first.x;
        const int y = window.first.y + window.height - 1 - corner.y - (column >> kTileShift);
        if (image.contains(x, y)) visit(plane[column], static_cast<std::size_t>(k), image.at(x, y));
      }
    }
  }
}

}  // namespace

MapWindow seen_window(const StoredMap& map, int margin) {
  Bounds bounds;
  for (const TileUpdate& update : map.tiles) add_tile(update, bounds);
  if (bounds.low_x > bounds.high_x) bounds.add(0, 0);
  const std::int64_t width = bounds.high_x - bounds.low_x + 1 + 2 * margin;
  const std::int64_t height = bounds.high_y - bounds.low_y + 1 + 2 * margin;
  if (width > kMaxColumns || height > kMaxColumns || width * height > kMaxColumns) {
    throw std::runtime_error("the map spans " + std::to_string(width) + " x " + std::to_string(height) +
                             " columns; a picture may have at most " + std::to_string(kMaxColumns));
  }
  return {
      {static_cast<std::int32_t>(bounds.low_x - margin), static_cast<std::int32_t>(bounds.low_y - margin)},
      static_cast<int>(width),
      static_cast<int>(height)};
}

Image<float> value_raster(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                          Operators operators) {
  check_layer(map, layer);
  Image<float> image(window.width, window.height);
  for_each_seen(map, window, layer, image, [&](const Cell& cell, std::size_t k, float& M) {
    const float mu_K = confidence(cell, map.info.full_confidence_rays[k]);
    M = std::clamp(map_value(operators, mu_E(cell), mu_O(cell), mu_K), M, 1.0F);
  });
  return image;
}

Image<std::uint8_t> grey_raster(const Image<float>& values) {
  Image<std::uint8_t> image(values.width, values.height);
  std::ranges::transform(values.pixels, image.pixels.begin(),
                         [](float M) { return static_cast<std::uint8_t>(std::lround(255 * (1 - M))); });
  return image;
}

Image<CellClass> class_raster(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                              Operators operators) {
  check_layer(map, layer);
  Image<CellClass> image(window.width, window.height, CellClass::unknown);
  for_each_seen(map, window, layer, image, [&](const Cell& cell, std::size_t, CellClass& fused) {
    fused = std::max(fused, classify(operators, cell, map.info.min_rays));
  });
  return image;
}

void check_layer(const StoredMap& map, LayerChoice layer) {
  const int num_layers = map.info.grid.num_layers();
  if (layer && (*layer < 0 || *layer >= num_layers)) {
    throw std::invalid_argument("layer must be from 0 to " + std::to_string(num_layers - 1) + ", got " +
                                std::to_string(*layer));
  }
}

}  // namespace flogmap
