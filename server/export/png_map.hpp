#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapping/flog/map_rules.hpp"
#include "mapping/tile_update.hpp"
#include "server/export/exported_file.hpp"

namespace flogmap {

/// `stem`.png, grey = 255 (1 - M), and the world file `stem`.pgw that tells any GIS where it lies, in metres.
/// One layer, or all fused. Throws std::invalid_argument if the map has no such layer.
std::vector<ExportedFile> png_map(const MapSnapshot& map, std::optional<int> layer, const Rules& rules,
                                  const std::string& stem);

}  // namespace flogmap
