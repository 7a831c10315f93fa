// Views into the map: the fan, the ray-by-ray reference and OctoMap, on the same views in one run. Prints a
// table and writes build/bench/map.json (or the path in the last argument). --quick leaves out OctoMap.
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "map_bench_octomap.hpp"
#include "map_bench_views.hpp"
#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_integrator.hpp"
#include "mapping/tile_memory.hpp"

namespace flogmap {
namespace {

constexpr int kRepeats = 7;  // the best counts: other programs only ever make it slower

double wall_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

MapIntegrator integrator_for(const BenchViews& bench, double cell_size_m, IntegratorKind kind,
                             int num_threads) {
  FlogOptions options;
  options.grid.cell_size_m = cell_size_m;
  options.integrator = kind;
  options.num_threads = num_threads;
  return {options, bench.camera, 128};
}

/// Median over the views of the best time of each, milliseconds by `clock`.
template <typename Clock>
double time_views(const BenchViews& bench, MapIntegrator integrator, int repeats, const Clock& clock) {
  std::vector<double> best(bench.views.size(), 1e300);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < bench.views.size(); ++i) {
      const double start = clock();
      integrator.integrate(bench.views[i]);
      best[i] = std::min(best[i], clock() - start);
    }
  }
  return median(best);
}

/// A map of `tiles` tiles around, but not in, the room.
MapSnapshot large_map(const MapInfo& info, int tiles) {
  MapSnapshot large{info, 1, {}};
  const Tile tile{TileCells(3 * kTileColumns, Cell{100, 100, 100, 0}), 1};
  for (int i = 0; i < tiles; ++i) large.tiles[{i % 142 - 71, i / 142 - 71}] = std::make_shared<Tile>(tile);
  return large;
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double total = 0, resident = 0;
  statm >> total >> resident;
  return resident * 4096 / 1e6;
}

/// Adding views to a map of `tiles` tiles: how much longer than to an empty one, and what lies in memory;
/// then again with a limit on the cells' memory.
void measure_large_map(const BenchViews& bench, int tiles, nlohmann::ordered_json& json) {
  constexpr std::size_t kLimitMb = 256;
  const double small =
      time_views(bench, integrator_for(bench, 0.02, IntegratorKind::fan, 1), kRepeats, cpu_ms);
  for (const bool limited : {false, true}) {
    ::malloc_trim(0);  // what the map before had
    if (limited) TileMemory::keep_within(kLimitMb << 20U, std::filesystem::current_path());
    MapIntegrator integrator = integrator_for(bench, 0.02, IntegratorKind::fan, 1);
    integrator.restore(large_map(integrator.info(), tiles));
    const double resident = resident_mb();
    const double ratio = time_views(bench, std::move(integrator), kRepeats, cpu_ms) / small;
    const std::string prefix = limited ? "large_map_limited_" : "large_map_";
    json[prefix + "time_ratio"] = ratio;
    json[prefix + "resident_mb"] = resident;
    std::printf(
        "a view on a map of %d tiles%s takes %.2f times as long as on an empty one; %.0f MB resident\n",
        tiles, limited ? ", cells limited to 256 MB," : "", ratio, resident);
  }
}

nlohmann::ordered_json measure(const BenchViews& bench, double cell_size_m, bool with_octomap) {
  std::vector<double> rays;
  for (const View& view : bench.views) {
    const auto& px = view.disparity.px.pixels;
    rays.push_back(static_cast<double>(std::count_if(px.begin(), px.end(), [](float d) { return d > 0; })));
  }
  nlohmann::ordered_json row;
  const auto run = [&](IntegratorKind kind, int threads, int repeats, double (*clock)()) {
    return time_views(bench, integrator_for(bench, cell_size_m, kind, threads), repeats, clock);
  };
  row["rays"] = median(rays);
  row["fan_ms_1_thread"] = run(IntegratorKind::fan, 1, kRepeats, cpu_ms);
  row["fan_wall_ms_1_thread"] = run(IntegratorKind::fan, 1, kRepeats, wall_ms);
  row["fan_ms_2_threads"] = run(IntegratorKind::fan, 2, kRepeats, wall_ms);
  row["reference_ms"] = run(IntegratorKind::ray, 1, 1, cpu_ms);
  MapIntegrator all = integrator_for(bench, cell_size_m, IntegratorKind::fan, 1);
  for (const View& view : bench.views) all.integrate(view);
  row["map_bytes"] = map_bytes(all.snapshot());
  if (with_octomap) {
    const OctomapResult octomap = run_octomap(bench, cell_size_m, 5);
    row["octomap_ms"] = median(octomap.ms);
    row["octomap_bytes"] = octomap.bytes;
  }
  return row;
}

void print(const std::string& name, const nlohmann::ordered_json& row) {
  const double fan = row["fan_ms_1_thread"], rays = row["rays"];
  std::printf("%-12s %8.0f %8.2f %8.2f %8.2f %9.1f %9.1f %7.2f %6.1f %7.2f", name.c_str(), rays, fan,
              row["fan_wall_ms_1_thread"].get<double>(), row["fan_ms_2_threads"].get<double>(),
              row["reference_ms"].get<double>(), row.value("octomap_ms", 0.0), rays / fan / 1e3,
              row["reference_ms"].get<double>() / fan, row["map_bytes"].get<double>() / 1e6);
  if (row.contains("octomap_bytes")) std::printf(" %8.1f", row["octomap_bytes"].get<double>() / 1e6);
  std::printf("\n");
  std::fflush(stdout);
}

int run(const std::vector<std::string_view>& arguments) {
  bool with_octomap = true;
  std::filesystem::path out = "build/bench/map.json";
  for (const std::string_view argument : arguments) {
    if (argument == "--quick") {
      with_octomap = false;
    } else {
      out = argument;
    }
  }
  std::printf("%-12s %8s %8s %8s %8s %9s %9s %7s %6s %7s %8s\n", "views", "rays", "fan ms", "1 wall",
              "2 wall", "ref ms", "octo ms", "Mray/s", "ref/fan", "MB", "octo MB");
  nlohmann::ordered_json json;
  for (const BenchViews& bench : {room_views(9), house_views()}) {
    if (bench.views.empty()) continue;
    for (const int mm : {20, 50}) {
      const bool main = bench.name == "room" && mm == 20;
      const std::string prefix = main ? "" : bench.name + "_" + std::to_string(mm) + "mm_";
      const nlohmann::ordered_json row = measure(bench, mm / 1000.0, with_octomap);
      for (const auto& [key, value] : row.items()) json[prefix + key] = value;
      print(bench.name + " " + std::to_string(mm) + " mm", row);
    }
  }
  measure_large_map(room_views(3), 20'000, json);
  if (out.has_parent_path()) std::filesystem::create_directories(out.parent_path());
  std::ofstream(out) << json.dump(1) << "\n";
  return 0;
}

}  // namespace
}  // namespace flogmap

int main(int argc, char** argv) { return flogmap::run({argv + 1, argv + argc}); }
