// flogmap merge: two stored maps of one place become one.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>

#include "mapping/flog/map_merge.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/continued_map.hpp"
#include "server/commands/output_path.hpp"
#include "server/map_store.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

struct MergeArguments {
  std::string a, b, out;
  MapPlacement b_in_a;
  OptionTable table;
};

StoredMap load_input(const std::string& file) {
  try {
    return load_settled_map(file);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

/// Farther away no cell has a number.
constexpr double kFarthest_m = 100'000;
constexpr double kDegree = std::numbers::pi / 180;

MapPlacement parse_placement(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, 3);
  if (std::max(std::abs(n[0]), std::abs(n[1])) > kFarthest_m || std::abs(n[2]) > 360)
    throw UsageError("allowed: x and y from -100000 to 100000 metres, yaw from -360 to 360 degrees");
  return {n[0], n[1], n[2] * kDegree};
}

std::string placement_text(const MapPlacement& p) {
  std::ostringstream text;
  text << p.x_m << ',' << p.y_m << ',' << p.yaw_rad / kDegree;
  return text.str();
}

int merge(const MergeArguments& arguments) {
  if (arguments.out.empty()) throw UsageError("--out is missing; for instance --out both.flog");
  check_output_file(arguments.out);
  const StoredMap a = load_input(arguments.a);
  const StoredMap b = load_input(arguments.b);
  MapSnapshot both;
  try {
    both = merge_maps(snapshot_of(a), snapshot_of(b), arguments.b_in_a);
  } catch (const std::exception& error) {
    throw UsageError(arguments.b + ": " + error.what());
  }
  StoredMap merged = a;  // keeps a's epoch, camera and path
  merged.revision = both.revision;
  merged.tiles.clear();
  for (const auto& [index, tile] : both.tiles) merged.tiles.push_back({index, tile->revision, tile});
  save_map(arguments.out, merged);
  std::printf("%s: %zu tiles (%zu and %zu before)\n", arguments.out.c_str(), merged.tiles.size(),
              a.tiles.size(), b.tiles.size());
  return 0;
}

}  // namespace

RunCommand add_merge(CLI::App& app) {
  auto arguments = std::make_shared<MergeArguments>();
  app.add_option("a", arguments->a, "the map whose world the result has")->required()->type_name("A.flog");
  app.add_option("b", arguments->b, "the map that is added")->required()->type_name("B.flog");
  OptionTable& table = arguments->table;
  table.add({.name = "b-in-a",
             .value_name = "x,y,yaw",
             .help = "where b lies in a: metres, metres, degrees",
             .parse = [to = arguments.get()](const std::string& text) { to->b_in_a = parse_placement(text); },
             .show = [of = arguments.get()] { return placement_text(of->b_in_a); }});
  table.text("out", "C.flog", arguments->out, "the merged map");
  table.attach(app);
  app.footer("Example: flogmap merge hall.flog office.flog --b-in-a 4.2,-1.0,90 --out both.flog");
  return [arguments] {
    arguments->table.apply(all_option_names());
    return merge(*arguments);
  };
}

}  // namespace flogmap
