// hub_demo PORT SECONDS [WEB_ROOT [CERT KEY]]: a synthetic map, growing, through the real Hub. See README.md.
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

/// Publishes 20 steps a second until told to stop or the time is up.
void walk(Hub& hub, FakeSession& session, std::chrono::seconds duration, const std::stop_token& stop) {
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
      auto tiles = walk.step();
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
    std::fprintf(stderr, "usage: hub_demo PORT SECONDS [WEB_ROOT [CERT KEY]]\n");
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
  const std::jthread walker([&](const std::stop_token& stop) { walk(hub, session, duration, stop); });
  hub.run();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "hub_demo: %s\n", error.what());
  return 1;
}
