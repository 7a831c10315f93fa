#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_rules.hpp"
#include "server/export/exported_file.hpp"

namespace flogmap {

/// How ROS map_server is to read the picture.
enum class RosMode : std::uint8_t {
  trinary,  // PGM: 0 occupied, 254 free, 205 unknown; K does not decide
  scale,    // PNG: 255 (1 - M), transparent where unknown
};

/// `stem`.pgm (or .png) and `stem`.yaml of one layer or of all fused.
std::vector<ExportedFile> ros_files(const MapSnapshot& map, const MapArea& area, std::optional<int> layer,
                                    const Rules& rules, RosMode mode, const std::string& stem);

/// map.* (fused) and layer_<k>.* of every layer, all cut to what was seen.
std::vector<ExportedFile> ros_map(const MapSnapshot& map, const Rules& rules, RosMode mode);

/// Writes ros_map() into a folder; layers that only an older map there had are removed.
void write_ros_map(const std::filesystem::path& folder, const MapSnapshot& map, const Rules& rules,
                   RosMode mode);

}  // namespace flogmap
