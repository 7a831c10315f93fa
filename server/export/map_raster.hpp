// The map as pictures of one pixel per column, north up: row 0 is the highest y.
#pragma once

#include <cstdint>
#include <optional>

#include "camera/image.hpp"
#include "mapping/flog/map_value.hpp"
#include "server/map_store.hpp"

namespace flogmap {

/// A rectangle of columns.
struct MapWindow {
  CellIndex first;  // lowest x and y
  int width = 0;    // columns
  int height = 0;
};

/// The smallest window that holds every column with a ray in it, and `margin` columns around; 1 x 1 at the
/// origin if there is none. Throws std::runtime_error if that is more than 2^28 columns.
MapWindow seen_window(const StoredMap& map, int margin = 0);

/// Which layers: one, or nothing for all fused.
using LayerChoice = std::optional<int>;

/// M of eqs. (11) and (12), in [0, 1]; layers are fused by max. 0 where nothing was seen.
Image<float> value_raster(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                          Operators operators);

/// grey = 255 (1 - M): white free or unknown, black occupied.
Image<std::uint8_t> grey_raster(const Image<float>& values);

/// Fused: occupied if any layer is, else free if any layer is, else unknown.
Image<CellClass> class_raster(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                              Operators operators);

/// Throws std::invalid_argument naming what is allowed if the map has no such layer.
void check_layer(const StoredMap& map, LayerChoice layer);

}  // namespace flogmap
