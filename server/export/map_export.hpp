// A stored map in the formats of other programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "mapping/flog/map_rules.hpp"
#include "server/export/exported_file.hpp"
#include "server/export/ros_map.hpp"
#include "server/map_store.hpp"

namespace flogmap {

enum class ExportFormat : std::uint8_t { ros, png, ply, pcd, bt, tum, kitti };

/// By name; throws std::invalid_argument naming what is allowed.
ExportFormat export_format(std::string_view name);

struct ExportOptions {
  Rules rules;               // what pictures show; `operators` also decides what is occupied in a .bt
  std::optional<int> layer;  // png: one layer instead of all fused
  RosMode ros_mode = RosMode::trinary;
};

/// One file as an answer over HTTP: `ros` is a tar archive of pictures and YAML, `png` the picture alone.
ExportedFile export_bytes(ExportFormat format, const StoredMap& map, const ExportOptions& options = {});

/// Writes `path`; `png` also the world file beside it. `ros` makes a folder of that name with map.pgm,
/// map.yaml and the same for every layer. Throws std::runtime_error naming the file that cannot be written.
void export_map(ExportFormat format, const StoredMap& map, const std::filesystem::path& path,
                const ExportOptions& options = {});

}  // namespace flogmap
