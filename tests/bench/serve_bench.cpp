// The server under load, the load a process of its own: viewers on a map that grows at 20 Hz, clients that
// fetch tiles, a map of 10,000 tiles, slow ones, and the real program. Prints a table and writes
// build/bench/serve.json.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "server/hub.hpp"
#include "tests/bench/affinity.hpp"
#include "tests/bench/serve_fetch.hpp"
#include "tests/bench/serve_load.hpp"
#include "tests/bench/serve_snapshot.hpp"
#include "tests/server/fake_session.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/running_program.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr seconds kPhase{4};

/// Resident memory of this process, KiB.
double resident_kib() {
  std::ifstream statm("/proc/self/statm");
  double total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1024;
}

/// Steps a second that the mapping side manages at a pace of 20 Hz, with work of its own in between.
double map_rate(Hub& hub, SyntheticWalk& walk, seconds duration) {
  const auto start = steady_clock::now();
  auto next = start;
  int steps = 0;
  for (; steady_clock::now() - start < duration; ++steps) {
    auto tiles = walk.step();
    if (!tiles.empty()) hub.publish(walk.revision(), std::move(tiles));
    TrackingReport report = walk.tracking();
    report.timestamp_ns = wall_ns();  // the viewers tell from it how old a pose is
    hub.publish_tracking(report);
    next += milliseconds(50);
    std::this_thread::sleep_until(next);
  }
  return steps / std::chrono::duration<double>(steady_clock::now() - start).count();
}

/// This program once more, as a client: `serve_bench --load ...`; its result comes back through a pipe.
class LoadProcess {
 public:
  explicit LoadProcess(const std::string& arguments)
      : pipe_(popen(("'" + std::filesystem::read_symlink("/proc/self/exe").string() + "' --load " + arguments)
                        .c_str(),
                    "r")) {
    if (!pipe_) throw std::runtime_error("the load cannot be started");
  }
  json result() {
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe_))
      text.append(part.data(), size);
    pclose(pipe_);
    return json::parse(text);
  }

 private:
  FILE* pipe_;
};

/// What a load process does: serve_bench --load watch PORT VIEWERS | stall PORT VIEWERS | get PORT TARGET
/// [PER_S] | again PORT TARGET | slow PORT TARGET | arrive PORT | come_back PORT EPOCH REVISION
int load(const std::vector<std::string>& arguments) {
  const std::string& what = arguments.at(0);
  const auto port = static_cast<std::uint16_t>(std::stoi(arguments.at(1)));
  json result;
  if (what == "watch" || what == "stall") keep_to_core(0, kNetworkCore);
  if (what == "watch") result = watch(port, std::stoi(arguments.at(2)), 2 * kPhase);
  if (what == "stall") result = stall(port, std::stoi(arguments.at(2)), kPhase);
  if (what == "again") result = fetch(port, {.target = arguments.at(2), .conditional = true}, kPhase);
  if (what == "get") {
    const double per_s = arguments.size() > 3 ? std::stod(arguments[3]) : 0;
    result = fetch(port, {.target = arguments.at(2), .per_s = per_s}, kPhase);
  }
  if (what == "slow") result = beside_slow_ones(port, arguments.at(2));
  if (what == "arrive") result = arrive(port);
  if (what == "come_back") result = come_back(port, arguments.at(2), std::stoull(arguments.at(3)));
  std::printf("%s\n", result.dump().c_str());
  return 0;
}

json result_of(const std::string& load, std::uint16_t port, const std::string& more = {}) {
  return LoadProcess(load + " " + std::to_string(port) + " " + more).result();
}

/// 200 viewers on a map that grows at 20 Hz; then as many that read nothing. The network's thread shares a
/// core with them, what stands for the mapping has the other.
json measure_viewers(Hub& hub, SyntheticWalk& walk, int viewers) {
  keep_to_core(0, kMappingCore);
  const std::string more = std::to_string(hub.port()) + " " + std::to_string(viewers);
  const double alone = map_rate(hub, walk, kPhase);
  const double before_kib = resident_kib();
  LoadProcess watching("watch " + more);
  std::this_thread::sleep_for(kPhase / 2);
  const double watched = map_rate(hub, walk, kPhase);
  const double with_viewers_kib = resident_kib();
  json out = watching.result();
  out["publish_rate_ratio"] = watched / alone;
  out["idle_client_kib"] = std::max(0.0, with_viewers_kib - before_kib) / viewers;
  std::this_thread::sleep_for(seconds(1));
  LoadProcess stalled("stall " + more);
  map_rate(hub, walk, kPhase - seconds(1));
  // Against the time before any viewer, for memory that was given back inside the process does not show
  // again.
  out["stalled_client_kib"] = std::max(0.0, resident_kib() - before_kib) / viewers;
  stalled.result();
  keep_to_no_core();
  return out;
}

json measure_fetches(std::uint16_t port) {
  const std::string tile = a_tile_target(port);
  const BareServer bare;
  const double bare_per_s = result_of("get", bare.port(), "/")["per_s"];
  const double tiles_per_s = result_of("get", port, tile)["per_s"];
  const double not_modified_per_s = result_of("again", port, tile)["per_s"];
  const json half = result_of("get", port, tile + " " + std::to_string(tiles_per_s / 2));
  json out = {{"bare_per_s", bare_per_s},
              {"tile_get_per_s", tiles_per_s},
              {"not_modified_per_s", not_modified_per_s},
              {"tile_get_ratio", tiles_per_s / bare_per_s},
              {"not_modified_ratio", not_modified_per_s / bare_per_s},
              {"half_load_per_s", half["per_s"]},
              {"half_load_p50_ms", half["p50_ms"]},
              {"half_load_p99_ms", half["p99_ms"]}};
  out.update(result_of("slow", port, tile));
  return out;
}

/// A map of 10,000 tiles: one who arrives, and one who comes back after 50 of them have changed.
json measure_large_map() {
  constexpr int kSide = 100, kChanged = 50;
  FakeSession session;
  ServeOptions options;
  options.port = 0;
  Hub hub(options, session, {});
  std::thread network([&] { hub.run(); });
  const MapBegin map = large_map(kSide);
  hub.begin(map);
  json out = result_of("arrive", hub.port());
  hub.publish(2, changed_tiles(map, kChanged, 2));
  std::this_thread::sleep_for(milliseconds(500));
  out.update(result_of("come_back", hub.port(), map.epoch + " 1"));
  out["resume_changed"] = kChanged;
  hub.drain("done");
  network.join();
  return out;
}

/// Frames a second of the real program, by its own counter.
double frames_per_s(std::uint16_t port, seconds duration) {
  const auto frames = [port] {
    return json::parse(http(port, "GET", "/api/v1/session").body)["frames"].get<double>();
  };
  const double before = frames();
  const auto start = steady_clock::now();
  std::this_thread::sleep_for(duration);
  return (frames() - before) / std::chrono::duration<double>(steady_clock::now() - start).count();
}

/// The simulated room through two cameras of 752x480 at 20 Hz.
std::string wide_room(const std::filesystem::path& folder) {
  std::ifstream room(FLOGMAP_SOURCE_DIR "/camera/simulation/scenes/room.json");
  json scene = json::parse(room);
  scene["camera"] = {
      {"width_px", 752}, {"height_px", 480}, {"focal_px", 435}, {"baseline_m", 0.12}, {"rate_hz", 20}};
  const std::filesystem::path file = folder / "room-752x480.json";
  std::ofstream(file) << scene;
  return "sim:" + file.string();
}

/// The real program, alone and with viewers: its threads but one on one core, network and viewers on the
/// other. What a camera would do, the rendering, is on the mapping's core too.
json measure_mapping(int viewers) {
  const std::string connections = std::to_string(viewers + 32);
  const auto folder = std::filesystem::temp_directory_path() / ("serve_bench." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  RunningProgram program({"--source", wide_room(folder), "--threads", "1", "--max-connections", connections,
                          "--max-connections-per-address", connections});
  std::filesystem::remove_all(folder);
  std::this_thread::sleep_for(seconds(3));
  keep_program_to_cores(program.pid());
  const double alone = frames_per_s(program.port(), 2 * kPhase);
  LoadProcess watching("watch " + std::to_string(program.port()) + " " + std::to_string(viewers));
  std::this_thread::sleep_for(kPhase / 4);
  const double watched = frames_per_s(program.port(), 2 * kPhase - kPhase / 2);
  watching.result();
  return {{"map_fps_alone", alone}, {"map_fps_watched", watched}, {"map_rate_ratio", watched / alone}};
}

json measure(int viewers) {
  ServeOptions options;
  options.port = 0;
  options.max_connections = options.max_connections_per_address = std::max(viewers, 200) + 32;
  FakeSession session;
  Hub hub(options, session, {});
  SyntheticWalk walk;
  std::thread network([&] {
    keep_to_core(0, kNetworkCore);
    hub.run();
  });
  hub.begin(walk.begin("bench00000000001", "started"));
  json out = {{"viewers", viewers}};
  out.update(measure_viewers(hub, walk, viewers));
  out.update(measure_fetches(hub.port()));
  hub.drain("done");
  network.join();
  out.update(measure_large_map());
  out.update(measure_mapping(viewers));
  return out;
}

int bench(int viewers) {
  const std::filesystem::path json_file = "build/bench/serve.json";
  const json document = measure(viewers);
  for (const auto& [key, value] : document.items())
    std::printf("%-24s %s\n", key.c_str(), value.dump().c_str());
  std::filesystem::create_directories(json_file.parent_path());
  std::ofstream(json_file) << document.dump(2) << '\n';
  return 0;
}

}  // namespace
}  // namespace flogmap

/// serve_bench [VIEWERS]
int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments[0] == "--load")
    return flogmap::load({arguments.begin() + 1, arguments.end()});
  return flogmap::bench(arguments.empty() ? 200 : std::stoi(arguments[0]));
}
