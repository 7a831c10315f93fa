// The network side under load: viewers as a separate process, poses at 20 Hz and a growing map. Prints a
// table and writes build/bench/serve.json (path in the first argument).
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
#include "tests/bench/serve_load.hpp"
#include "tests/server/fake_session.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr int kViewers = 200;
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
  nlohmann::json result() {
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe_))
      text.append(part.data(), size);
    pclose(pipe_);
    return nlohmann::json::parse(text);
  }

 private:
  FILE* pipe_;
};

/// serve_bench --load watch PORT VIEWERS | get PORT TARGET | again PORT TARGET
int load(const std::vector<std::string>& arguments) {
  const auto port = static_cast<std::uint16_t>(std::stoi(arguments.at(1)));
  const bool watches = arguments.at(0) == "watch";
  const nlohmann::json result = watches ? watch(port, std::stoi(arguments.at(2)), 2 * kPhase)
                                        : fetch(port, arguments.at(2), arguments.at(0) == "again", kPhase);
  std::printf("%s\n", result.dump().c_str());
  return 0;
}

double fetches_per_s(const std::string& kind, std::uint16_t port, const std::string& target) {
  return LoadProcess(kind + " " + std::to_string(port) + " " + target).result()["per_s"];
}

nlohmann::json measure(Hub& hub, SyntheticWalk& walk) {
  nlohmann::json out = {{"viewers", kViewers}};
  const std::uint16_t port = hub.port();
  const double alone = map_rate(hub, walk, kPhase);
  const double before_kib = resident_kib();
  LoadProcess viewers("watch " + std::to_string(port) + " " + std::to_string(kViewers));
  std::this_thread::sleep_for(kPhase / 2);
  const double watched = map_rate(hub, walk, kPhase);
  out["idle_client_kib"] = std::max(0.0, resident_kib() - before_kib) / kViewers;
  out["map_rate_ratio"] = watched / alone;
  const nlohmann::json seen = viewers.result();
  out["pose_p50_ms"] = seen["pose_p50_ms"];
  out["pose_p99_ms"] = seen["pose_p99_ms"];
  out["viewers_served"] = seen["viewers_served"];
  const std::string tile = a_tile_target(port);
  const BareServer bare;
  const double bare_per_s = fetches_per_s("get", bare.port(), "/");
  const double tiles_per_s = fetches_per_s("get", port, tile),
               not_modified_per_s = fetches_per_s("again", port, tile);
  out["bare_per_s"] = bare_per_s;
  out["tile_get_per_s"] = tiles_per_s;
  out["not_modified_per_s"] = not_modified_per_s;
  out["tile_get_ratio"] = tiles_per_s / bare_per_s;
  out["not_modified_ratio"] = not_modified_per_s / bare_per_s;
  return out;
}

int bench(const std::filesystem::path& json_file) {
  ServeOptions options;
  options.port = 0;
  options.max_connections = options.max_connections_per_address = kViewers + 32;
  FakeSession session;
  Hub hub(options, session, {});
  SyntheticWalk walk;
  std::thread network([&] { hub.run(); });
  hub.begin(walk.begin("bench00000000001", "started"));
  const nlohmann::json document = measure(hub, walk);
  hub.drain("done");
  network.join();
  for (const auto& [key, value] : document.items())
    std::printf("%-24s %s\n", key.c_str(), value.dump().c_str());
  std::filesystem::create_directories(json_file.parent_path());
  std::ofstream(json_file) << document.dump(2) << '\n';
  return 0;
}

}  // namespace
}  // namespace flogmap

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments[0] == "--load")
    return flogmap::load({arguments.begin() + 1, arguments.end()});
  return flogmap::bench(arguments.empty() ? "build/bench/serve.json" : arguments[0]);
}
