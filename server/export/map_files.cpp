#include "server/export/map_files.hpp"

#include <optional>
#include <string>
#include <vector>

#include "mapping/flog/map_picture.hpp"
#include "server/export/exported_file.hpp"
#include "server/export/path_picture.hpp"
#include "server/export/picture_area.hpp"
#include "server/export/picture_file.hpp"
#include "server/export/ros_map.hpp"
#include "server/export/trajectory_text.hpp"

namespace flogmap {
namespace {

std::vector<ExportedFile> pictures(const MapSnapshot& map, const Rules& rules) {
  const MapArea area = picture_area(map);
  const auto picture = [&](std::optional<int> layer, const std::string& name) {
    return ExportedFile{name, "image/png", png_of(map_picture(map, area, layer, rules).grey)};
  };
  std::vector<ExportedFile> files{picture({}, "fused.png")};
  for (int k = 0; k < map.info.grid.num_layers(); ++k) {
    files.push_back(picture(k, "layer_" + std::to_string(k) + ".png"));
  }
  return files;
}

}  // namespace

void write_map_folder(const std::filesystem::path& folder, const StoredMap& map, Operators operators) {
  Rules rules;
  rules.operators = operators;
  const MapSnapshot snapshot = snapshot_of(map);
  write_files(folder, {{"trajectory.tum", "text/plain", tum_of(map.trajectory)}});
  save_map(folder / "map.flog", map);
  write_files(folder, pictures(snapshot, rules));
  remove_numbered_from(folder, "layer_", ".png", map.info.grid.num_layers());
  write_files(folder, {{"path.png", "image/png", png_of(path_picture(map, operators))}});
  write_ros_map(folder / "ros", snapshot, rules, RosMode::trinary);
}

}  // namespace flogmap
