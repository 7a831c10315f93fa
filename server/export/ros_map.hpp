#pragma once

#include <string>
#include <vector>

#include "server/export/exported_file.hpp"
#include "server/export/map_raster.hpp"

namespace flogmap {

/// How ROS map_server is to read the picture.
enum class RosMode : std::uint8_t {
  trinary,  // PGM: 0 occupied, 254 free, 205 unknown; K does not decide
  scale,    // PNG: 255 (1 - M), transparent where unknown
};

/// `stem`.pgm (or .png) and `stem`.yaml of one layer or of all fused, cut to `window`.
std::vector<ExportedFile> ros_files(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                                    Operators operators, RosMode mode, const std::string& stem);

/// map.* (fused) and layer_<k>.* of every layer, all cut to what was seen.
std::vector<ExportedFile> ros_map(const StoredMap& map, Operators operators, RosMode mode);

}  // namespace flogmap
