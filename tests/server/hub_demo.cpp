// hub_demo PORT SECONDS [WEB_ROOT [HOUSES | CERT KEY]]: a synthetic map, growing, through the real Hub; of
// one house, or of HOUSES alike, each of about 60 tiles: in the first round all of them grow at once, then
// the camera walks a round in one after the other. See README.md.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>

#include "server/hub.hpp"
#include "tests/server/fake_session.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace {

using namespace flogmap;
using std::chrono::steady_clock;

constexpr int kHouseTilesX = 11, kHouseTilesY = 8, kHousesInARow = 4;

/// What happens in one house happens in all; after the first round, in that of the round.
std::vector<TileUpdate> in_houses(const std::vector<TileUpdate>& tiles, int num_houses, int round) {
  std::vector<TileUpdate> all;
  for (int house = 0; house < num_houses; ++house) {
    if (round > 0 && house != round % num_houses) continue;
    const int dx = kHouseTilesX * (house % kHousesInARow), dy = kHouseTilesY * (house / kHousesInARow);
    for (TileUpdate update : tiles) {
      update.index = {update.index.x + dx, update.index.y + dy};
      all.push_back(std::move(update));
    }
  }
  return all;
}

/// Publishes 20 steps a second until told to stop or the time is up.
void walk(Hub& hub, FakeSession& session, int num_houses, std::chrono::seconds duration,
          const std::stop_token& stop) {
  SyntheticWalk walk;
  int epoch = 1;
  hub.begin(walk.begin("demo000000000001", "started"));
  const auto start = steady_clock::now();
  auto next = start;
  while (!stop.stop_requested() && steady_clock::now() - start < duration) {
    if (session.take_resets() > 0) {
      walk = SyntheticWalk();
      hub.begin(walk.begin("demo00000000000" + std::to_string(++epoch % 10), "reset by operator"));
    }
    if (!session.playback().paused || session.take_steps() > 0) {
      const int round = static_cast<int>(walk.num_steps() / SyntheticWalk::kStepsPerRound);
      auto tiles = in_houses(walk.step(), num_houses, round);
      if (!tiles.empty()) hub.publish(walk.revision(), std::move(tiles));
      hub.publish_tracking(walk.tracking());
      if (hub.wants_pictures()) hub.publish_pictures(walk.pictures());
      if (walk.num_steps() % 10 == 0) hub.publish_status(walk.status());
      session.advance(0.05);
    }
    next += std::chrono::milliseconds(50);
    std::this_thread::sleep_until(next);
  }
  hub.drain("the demo is over");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) {
    std::fprintf(stderr, "usage: hub_demo PORT SECONDS [WEB_ROOT [HOUSES | CERT KEY]]\n");
    return 2;
  }
  ServeOptions options;
  options.port = static_cast<std::uint16_t>(std::atoi(argv[1]));
  if (argc > 3) options.web_root = argv[3];
  if (argc > 5) {
    options.tls_cert = argv[4];
    options.tls_key = argv[5];
  }
  FakeSession session;
  HubInfo info;
  info.version = "demo";
  Hub hub(options, session, info);
  hub.drain_on_signals();
  std::printf("%s://127.0.0.1:%d\n", options.tls_cert.empty() ? "http" : "https", hub.port());
  std::fflush(stdout);
  const std::chrono::seconds duration(std::atoi(argv[2]));
  const int num_houses = argc == 5 ? std::atoi(argv[4]) : 1;
  const std::jthread walker(
      [&](const std::stop_token& stop) { walk(hub, session, num_houses, duration, stop); });
  hub.run();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "hub_demo: %s\n", error.what());
  return 1;
}
