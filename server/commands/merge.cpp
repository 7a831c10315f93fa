// flogmap merge: two stored maps of one place become one.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include "mapping/flog/map_merge.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/continued_map.hpp"
#include "server/map_store.hpp"
#include "server/option_table.hpp"

namespace flogmap {
namespace {

struct MergeArguments {
  std::string a, b, placement = "0,0,0", out;
};

StoredMap load_input(const std::string& file) {
  try {
    return load_settled_map(file);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

MapPlacement parse_placement(const std::string& text) {
  try {
    const std::vector<double> n = parse_numbers(text, 3);
    return {n[0], n[1], n[2] * std::numbers::pi / 180};
  } catch (const UsageError& error) {
    throw UsageError("--b-in-a " + text + ": " + error.what());
  }
}

int merge(const MergeArguments& arguments) {
  if (arguments.out.empty()) throw UsageError("--out is missing; for instance --out both.flog");
  const StoredMap a = load_input(arguments.a);
  const StoredMap b = load_input(arguments.b);
  MapSnapshot both;
  try {
    both = merge_maps(snapshot_of(a), snapshot_of(b), parse_placement(arguments.placement));
  } catch (const UsageError&) {
    throw;
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
  app.add_option("--b-in-a", arguments->placement, "where b lies in a: metres, metres, degrees")
      ->type_name("x,y,yaw");
  app.add_option("--out", arguments->out, "the merged map")->type_name("C.flog");
  app.footer("Example: flogmap merge hall.flog office.flog --b-in-a 4.2,-1.0,90 --out both.flog");
  return [arguments] { return merge(*arguments); };
}

}  // namespace flogmap
