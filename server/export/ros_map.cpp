// For ROS map_server: https://wiki.ros.org/map_server, sections "Map format" and "Value interpretation".
#include "server/export/ros_map.hpp"

#include <filesystem>
#include <utility>

#include "mapping/flog/map_picture.hpp"
#include "mapping/flog/map_planes.hpp"
#include "server/export/picture_area.hpp"
#include "server/export/picture_file.hpp"

namespace flogmap {
namespace {

std::string pgm_of(const Image<std::uint8_t>& grey) {
  const std::string size = std::to_string(grey.width) + " " + std::to_string(grey.height);
  std::string bytes = "P5\n" + size + "\n255\n";
  return bytes.append(grey.pixels.begin(), grey.pixels.end());
}

std::string scale_png(const Image<std::uint8_t>& trinary, const Image<std::uint8_t>& grey) {
  Image<GreyAlpha> picture(grey.width, grey.height);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const bool known = trinary.pixels[i] != kTrinaryUnknown;
    picture.pixels[i] = {grey.pixels[i], static_cast<std::uint8_t>(known ? 255 : 0)};
  }
  return png_of(picture);
}

/// The origin is the lower left corner of the lower left pixel.
std::string yaml_of(const std::string& image, const MapPicture& picture, RosMode mode) {
  return "image: " + image + "\nresolution: " + shortest_text(picture.cell_size_m) + "\norigin: [" +
         shortest_text(picture.origin_x_m()) + ", " + shortest_text(picture.origin_y_m()) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: " +
         (mode == RosMode::trinary ? "trinary" : "scale") + "\n";
}

}  // namespace

std::vector<ExportedFile> ros_files(const MapSnapshot& map, const MapArea& area, std::optional<int> layer,
                                    const Rules& rules, RosMode mode, const std::string& stem) {
  const MapPicture trinary = trinary_picture(map, area, layer, rules);
  ExportedFile picture{stem + ".pgm", "image/x-portable-graymap", {}};
  if (mode == RosMode::trinary) {
    picture.bytes = pgm_of(trinary.grey);
  } else {
    picture = {stem + ".png", "image/png",
               scale_png(trinary.grey, map_picture(map, area, layer, rules).grey)};
  }
  const std::string image = std::filesystem::path(picture.name).filename().string();
  return {picture, {stem + ".yaml", "application/yaml", yaml_of(image, trinary, mode)}};
}

std::vector<ExportedFile> ros_map(const MapSnapshot& map, const Rules& rules, RosMode mode) {
  const MapArea area = picture_area(map);
  std::vector<ExportedFile> files = ros_files(map, area, {}, rules, mode, "map");
  for (int k = 0; k < map.info.grid.num_layers(); ++k) {
    for (auto& file : ros_files(map, area, k, rules, mode, "layer_" + std::to_string(k))) {
      files.push_back(std::move(file));
    }
  }
  return files;
}

void write_ros_map(const std::filesystem::path& folder, const MapSnapshot& map, const Rules& rules,
                   RosMode mode) {
  write_files(folder, ros_map(map, rules, mode));
  for (const char* extension : {".pgm", ".yaml"})
    remove_numbered_from(folder, "layer_", extension, map.info.grid.num_layers());
}

}  // namespace flogmap
