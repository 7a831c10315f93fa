#include "server/export/png_map.hpp"

#include <stdexcept>

#include "mapping/flog/map_picture.hpp"
#include "server/export/picture_area.hpp"
#include "server/export/picture_file.hpp"

namespace flogmap {
namespace {

/// World file: pixel size along x, two rotations, pixel size along y (down), middle of the upper left pixel.
std::string world_file(const GridSpec& grid, const MapArea& area) {
  const std::string side = shortest_text(grid.cell_size_m);
  return side + "\n0\n0\n-" + side + "\n" + shortest_text(cell_middle_m(grid, area.low.x)) + "\n" +
         shortest_text(cell_middle_m(grid, area.high.y - 1)) + "\n";
}

void check_layer(const MapSnapshot& map, std::optional<int> layer) {
  const int num_layers = map.info.grid.num_layers();
  if (layer && (*layer < 0 || *layer >= num_layers)) {
    throw std::invalid_argument("layer must be from 0 to " + std::to_string(num_layers - 1) + ", got " +
                                std::to_string(*layer));
  }
}

}  // namespace

std::vector<ExportedFile> png_map(const MapSnapshot& map, std::optional<int> layer, const Rules& rules,
                                  const std::string& stem) {
  check_layer(map, layer);
  const MapPicture picture = map_picture(map, picture_area(map), layer, rules);
  return {{stem + ".png", "image/png", png_of(picture.grey)},
          {stem + ".pgw", "text/plain", world_file(map.info.grid, picture.area)}};
}

}  // namespace flogmap
