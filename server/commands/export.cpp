// flogmap export: a stored map in the format of another program.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "server/commands/commands.hpp"
#include "server/commands/continued_map.hpp"
#include "server/commands/output_path.hpp"
#include "server/export/map_export.hpp"
#include "server/map_store.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

struct ExportArguments {
  std::string store, format, out;
  std::optional<int> layer;
  bool scale = false;
  OptionTable table;
};

int parse_layer(const std::string& text) {
  constexpr int kMostLayers = 64;
  const double layer = parse_numbers(text, 1)[0];
  if (layer < 0 || layer >= kMostLayers || layer != std::floor(layer))
    throw UsageError("allowed: the number of a layer, 0 for the lowest");
  return static_cast<int>(layer);
}

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

/// What a format has no use for is a mistake.
void check_meaning(const ExportArguments& arguments, ExportFormat format) {
  if (arguments.layer && format != ExportFormat::png) {
    throw UsageError("--layer " + std::to_string(*arguments.layer) + ": not with --format " +
                     arguments.format + "; allowed with png");
  }
  if (arguments.scale && format != ExportFormat::ros)
    throw UsageError("--scale: not with --format " + arguments.format + "; allowed with ros");
}

ExportOptions options_for(const StoredMap& map, const ExportArguments& arguments) {
  ExportOptions options;
  if (arguments.layer && *arguments.layer >= map.info.grid.num_layers()) {
    throw UsageError("--layer " + std::to_string(*arguments.layer) + ": the map has layers 0 to " +
                     std::to_string(map.info.grid.num_layers() - 1));
  }
  options.layer = arguments.layer;
  if (arguments.scale) options.ros_mode = RosMode::scale;
  return options;
}

int export_stored(const ExportArguments& arguments) {
  const ExportFormat format = format_of(arguments.format);
  if (arguments.out.empty()) throw UsageError("--out is missing; for instance --out map." + arguments.format);
  check_meaning(arguments, format);
  if (format == ExportFormat::ros) {
    make_output_folder(arguments.out);
  } else {
    check_output_file(arguments.out);
  }
  const StoredMap map = load_input(arguments.store);
  const ExportOptions options = options_for(map, arguments);
  export_map(format, map, arguments.out, options);
  std::printf("%s: %zu tiles, %zu poses written as %s\n", arguments.out.c_str(), map.tiles.size(),
              map.trajectory.size(), arguments.format.c_str());
  return 0;
}

}  // namespace

RunCommand add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  OptionTable& table = arguments->table;
  table.text("store", "FILE", arguments->store, "the stored map");
  table.text(
      "format", "ros|png|ply|pcd|bt|tum|kitti", arguments->format,
      "ros: folder of PGM and YAML; png: picture and world file; ply, pcd: points with their evidence; "
      "bt: OctoMap; tum, kitti: the path");
  table.text("out", "PATH", arguments->out, "file, or folder for ros");
  table.add({.name = "layer",
             .value_name = "K",
             .help = "png: this layer alone instead of all fused",
             .parse = [to = arguments.get()](const std::string& text) { to->layer = parse_layer(text); },
             .show = [of = arguments.get()] { return of->layer ? std::to_string(*of->layer) : ""; }});
  table.flag("scale", arguments->scale, "ros: grey values instead of three classes");
  table.attach(app);
  app.footer("Example: flogmap export --store map.flog --format ros --out /tmp/ros_map");
  return [arguments] {
    arguments->table.apply(all_option_names());
    return export_stored(*arguments);
  };
}

}  // namespace flogmap
