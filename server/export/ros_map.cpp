// For ROS map_server: https://wiki.ros.org/map_server, sections "Map format" and "Value interpretation".
#include "server/export/ros_map.hpp"

#include <filesystem>

#include "server/export/picture_file.hpp"

namespace flogmap {
namespace {

char trinary_pixel(CellClass cell) {
  switch (cell) {
    case CellClass::occupied:
      return 0;
    case CellClass::free:
      return static_cast<char>(254);
    case CellClass::unknown:
      break;
  }
  return static_cast<char>(205);
}

std::string pgm_of(const Image<CellClass>& classes) {
  std::string bytes =
      "P5\n" + std::to_string(classes.width) + " " + std::to_string(classes.height) + "\n255\n";
  for (const CellClass cell : classes.pixels) bytes += trinary_pixel(cell);
  return bytes;
}

std::string scale_png(const Image<CellClass>& classes, const Image<float>& values) {
  const Image<std::uint8_t> grey = grey_raster(values);
  Image<GreyAlpha> picture(grey.width, grey.height);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const bool known = classes.pixels[i] != CellClass::unknown;
    picture.pixels[i] = {grey.pixels[i], static_cast<std::uint8_t>(known ? 255 : 0)};
  }
  return png_of(picture);
}

/// The origin is the lower left corner of the lower left pixel.
std::string yaml_of(const std::string& image, const GridSpec& grid, const MapWindow& window, RosMode mode) {
  const double a = grid.cell_size_m;
  return "image: " + image + "\nresolution: " + shortest_text(a) + "\norigin: [" +
         shortest_text(window.first.x * a) + ", " + shortest_text(window.first.y * a) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: " +
         (mode == RosMode::trinary ? "trinary" : "scale") + "\n";
}

}  // namespace

std::vector<ExportedFile> ros_files(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                                    Operators operators, RosMode mode, const std::string& stem) {
  const Image<CellClass> classes = class_raster(map, window, layer, operators);
  ExportedFile picture;
  if (mode == RosMode::trinary) {
    picture = {stem + ".pgm", "image/x-portable-graymap", pgm_of(classes)};
  } else {
    picture = {stem + ".png", "image/png", scale_png(classes, value_raster(map, window, layer, operators))};
  }
  const std::string image = std::filesystem::path(picture.name).filename().string();
  return {picture, {stem + ".yaml", "application/yaml", yaml_of(image, map.info.grid, window, mode)}};
}

std::vector<ExportedFile> ros_map(const StoredMap& map, Operators operators, RosMode mode) {
  const MapWindow window = seen_window(map);
  std::vector<ExportedFile> files = ros_files(map, window, {}, operators, mode, "map");
  for (int k = 0; k < map.info.grid.num_layers(); ++k) {
    for (auto& file : ros_files(map, window, k, operators, mode, "layer_" + std::to_string(k))) {
      files.push_back(std::move(file));
    }
  }
  return files;
}

}  // namespace flogmap
