#include "server/export/map_export.hpp"

#include <array>
#include <stdexcept>
#include <utility>

#include "server/export/cell_cloud.hpp"
#include "server/export/octomap_map.hpp"
#include "server/export/png_map.hpp"
#include "server/export/trajectory_text.hpp"

namespace flogmap {
namespace {

constexpr std::array<std::pair<std::string_view, ExportFormat>, 7> kFormats{{{"ros", ExportFormat::ros},
                                                                             {"png", ExportFormat::png},
                                                                             {"ply", ExportFormat::ply},
                                                                             {"pcd", ExportFormat::pcd},
                                                                             {"bt", ExportFormat::bt},
                                                                             {"tum", ExportFormat::tum},
                                                                             {"kitti", ExportFormat::kitti}}};
constexpr const char* kBinary = "application/octet-stream";

void write_png(const StoredMap& map, const std::filesystem::path& path, const ExportOptions& options) {
  const auto files = png_map(snapshot_of(map), options.layer, options.rules, "map");
  write_file(path, files[0].bytes);
  write_file(std::filesystem::path(path).replace_extension(".pgw"), files[1].bytes);
}

}  // namespace

ExportFormat export_format(std::string_view name) {
  std::string allowed;
  for (const auto& [known, format] : kFormats) {
    if (known == name) return format;
    allowed += (allowed.empty() ? "" : ", ") + std::string(known);
  }
  throw std::invalid_argument("format must be one of " + allowed + ", got '" + std::string(name) + "'");
}

ExportedFile export_bytes(ExportFormat format, const StoredMap& map, const ExportOptions& options) {
  switch (format) {
    case ExportFormat::ros:
      return {"map.tar", "application/x-tar",
              tar_of(ros_map(snapshot_of(map), options.rules, options.ros_mode))};
    case ExportFormat::png:
      return png_map(snapshot_of(map), options.layer, options.rules, "map")[0];
    case ExportFormat::ply:
      return {"map.ply", kBinary, ply_of(cell_cloud(map))};
    case ExportFormat::pcd:
      return {"map.pcd", kBinary, pcd_of(cell_cloud(map))};
    case ExportFormat::bt:
      return {"map.bt", kBinary, octomap_of(map, options.rules.operators)};
    case ExportFormat::tum:
      return {"trajectory.tum", "text/plain", tum_of(map.trajectory)};
    case ExportFormat::kitti:
      break;
  }
  return {"trajectory.kitti", "text/plain", kitti_of(map.trajectory)};
}

void export_map(ExportFormat format, const StoredMap& map, const std::filesystem::path& path,
                const ExportOptions& options) {
  if (format == ExportFormat::ros) {
    write_ros_map(path, snapshot_of(map), options.rules, options.ros_mode);
  } else if (format == ExportFormat::png) {
    write_png(map, path, options);
  } else {
    write_file(path, export_bytes(format, map, options).bytes);
  }
}

}  // namespace flogmap
