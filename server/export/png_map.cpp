#include "server/export/png_map.hpp"

#include "server/export/picture_file.hpp"

namespace flogmap {
namespace {

/// World file: pixel size along x, two rotations, pixel size along y (down), middle of the upper left pixel.
std::string world_file(const GridSpec& grid, const MapWindow& window) {
  const double a = grid.cell_size_m;
  const double left_m = cell_middle_m(grid, window.first.x);
  const double top_m = cell_middle_m(grid, window.first.y + window.height - 1);
  return shortest_text(a) + "\n0\n0\n" + shortest_text(-a) + "\n" + shortest_text(left_m) + "\n" +
         shortest_text(top_m) + "\n";
}

}  // namespace

std::vector<ExportedFile> png_map(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                                  Operators operators, const std::string& stem) {
  const Image<float> values = value_raster(map, window, layer, operators);
  return {{stem + ".png", "image/png", png_of(grey_raster(values))},
          {stem + ".pgw", "text/plain", world_file(map.info.grid, window)}};
}

}  // namespace flogmap
