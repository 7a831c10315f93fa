#pragma once

#include "server/cell_column.hpp"
#include "server/served_map.hpp"

namespace flogmap {

/// All layers at a point, by the map's own rules; zero evidence where nothing was ever seen.
CellColumn inspect_cell(ServedMap& map, double x_m, double y_m);

/// A point that has a cell: finite and within the range of cell indices.
bool has_cell(const GridSpec& grid, double x_m, double y_m);

}  // namespace flogmap
