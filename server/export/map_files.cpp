#include "server/export/map_files.hpp"

#include <string>
#include <utility>

#include "server/export/exported_file.hpp"
#include "server/export/path_picture.hpp"
#include "server/export/picture_file.hpp"
#include "server/export/ros_map.hpp"
#include "server/export/trajectory_text.hpp"

namespace flogmap {
namespace {

std::vector<ExportedFile> pictures(const StoredMap& map, Operators operators) {
  const MapWindow window = seen_window(map);
  const auto picture = [&](LayerChoice layer, const std::string& name) {
    return ExportedFile{name, "image/png", png_of(grey_raster(value_raster(map, window, layer, operators)))};
  };
  std::vector<ExportedFile> files{picture({}, "fused.png")};
  for (int k = 0; k < map.info.grid.num_layers(); ++k) {
    files.push_back(picture(k, "layer_" + std::to_string(k) + ".png"));
  }
  files.push_back({"path.png", "image/png", png_of(path_picture(map, operators))});
  return files;
}

}  // namespace

void write_map_folder(const std::filesystem::path& folder, const StoredMap& map, Operators operators) {
  write_files(folder, {{"trajectory.tum", "text/plain", tum_of(map.trajectory)}});
  save_map(folder / "map.flog", map);
  write_files(folder, pictures(map, operators));
  write_files(folder / "ros", ros_map(map, operators, RosMode::trinary));
}

}  // namespace flogmap
