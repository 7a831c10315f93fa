// flogmap export: a stored map in the format of another program.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "server/commands/commands.hpp"
#include "server/commands/continued_map.hpp"
#include "server/export/map_export.hpp"
#include "server/map_store.hpp"
#include "server/option_table.hpp"

namespace flogmap {
namespace {

struct ExportArguments {
  std::string store, format, out;
  int layer = -1;
  bool scale = false;
};

ExportFormat format_of(const std::string& name) {
  if (name.empty()) throw UsageError("--format is missing; allowed: ros|png|ply|pcd|bt|tum|kitti");
  try {
    return export_format(name);
  } catch (const std::exception& error) {
    throw UsageError("--format " + name + ": " + error.what());
  }
}

StoredMap load_input(const std::string& file) {
  if (file.empty()) throw UsageError("--store is missing; for instance --store map.flog");
  try {
    return load_settled_map(file);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

int export_stored(const ExportArguments& arguments) {
  const ExportFormat format = format_of(arguments.format);
  if (arguments.out.empty()) throw UsageError("--out is missing; for instance --out map." + arguments.format);
  const StoredMap map = load_input(arguments.store);
  ExportOptions options;
  if (arguments.layer >= map.info.grid.num_layers()) {
    throw UsageError("--layer " + std::to_string(arguments.layer) + ": the map has layers 0 to " +
                     std::to_string(map.info.grid.num_layers() - 1));
  }
  if (arguments.layer >= 0) options.layer = arguments.layer;
  if (arguments.scale) options.ros_mode = RosMode::scale;
  export_map(format, map, arguments.out, options);
  std::printf("%s: %zu tiles, %zu poses written as %s\n", arguments.out.c_str(), map.tiles.size(),
              map.trajectory.size(), arguments.format.c_str());
  return 0;
}

}  // namespace

RunCommand add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  app.add_option("--store", arguments->store, "the stored map")->type_name("FILE");
  app.add_option(
         "--format", arguments->format,
         "ros: folder of PGM and YAML; png: picture and world file; ply, pcd: points with their evidence; "
         "bt: OctoMap; tum, kitti: the path")
      ->type_name("ros|png|ply|pcd|bt|tum|kitti");
  app.add_option("--out", arguments->out, "file, or folder for ros")->type_name("PATH");
  app.add_option("--layer", arguments->layer, "png: this layer alone instead of all fused")->type_name("K");
  app.add_flag("--scale", arguments->scale, "ros: grey values instead of three classes");
  app.footer("Example: flogmap export --store map.flog --format ros --out /tmp/ros_map");
  return [arguments] { return export_stored(*arguments); };
}

}  // namespace flogmap
