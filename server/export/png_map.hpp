#pragma once

#include <string>
#include <vector>

#include "server/export/exported_file.hpp"
#include "server/export/map_raster.hpp"

namespace flogmap {

/// `stem`.png, grey = 255 (1 - M), and the world file `stem`.pgw that tells any GIS where it lies, in metres.
std::vector<ExportedFile> png_map(const StoredMap& map, const MapWindow& window, LayerChoice layer,
                                  Operators operators, const std::string& stem);

}  // namespace flogmap
