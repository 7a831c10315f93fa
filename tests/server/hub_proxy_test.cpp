// Rule 5 over real sockets and a bad network: lines that are cut or stall in mid-message cost nothing but
// time.
#include <gtest/gtest.h>

#include <random>

#include "tests/server/cutting_proxy.hpp"
#include "tests/server/stream_fixture.hpp"

namespace flogmap {
namespace {

using std::chrono::milliseconds;

constexpr int kConnections = 60;
constexpr std::uint64_t kOpened = 1000;  // bytes from the server until the stream is open, at most

class ProxyTest : public StreamTest {
 protected:
  Weather random_weather() {
    const std::uint64_t bytes = random_() % 40'000;
    if (random_() % 3 == 0)
      return {.stall_after_bytes = kOpened + bytes};  // a client opens the stream without a deadline
    return {.cut_after_bytes = 100 + bytes};
  }

  /// Connects as a page does that comes back; nothing if the line broke during the handshake.
  std::unique_ptr<StreamClient> come_back(std::uint16_t port) {
    mirror_.reconnect();
    try {
      auto client = std::make_unique<StreamClient>(port);
      const Resume known{mirror_.epoch(), mirror_.complete_revision(), mirror_.path_ns().size()};
      client->send(mirror_.epoch().empty() ? hello_frame() : hello_frame(known));
      client->send(subscribe_frame(kEvidence));
      return client;
    } catch (const std::exception&) {
      return nullptr;
    }
  }

  void read_while_it_lasts(StreamClient& client) {
    for (int i = 0; i < 40; ++i) {
      const auto message = client.read(milliseconds(60));
      if (!message) return;
      mirror_.take(*message);
      if (random_() % 3 > 0) client.send(ack_frame(mirror_.batch_bytes()));
      if (random_() % 8 == 0) step(1);
    }
  }

  TileMirror mirror_;
  std::mt19937 random_{7};
};

TEST_F(ProxyTest, HoweverOftenTheLineBreaksTheClientEndsWithTheServersTiles) {
  begin();
  step(30);
  CuttingProxy proxy(server_.port());
  int broken = 0;
  for (int i = 0; i < kConnections; ++i) {
    proxy.set(random_weather());
    const auto client = come_back(proxy.port());
    if (client) read_while_it_lasts(*client);
    broken += client ? 0 : 1;
    step(1);
  }
  EXPECT_LT(broken, kConnections / 4);  // most got as far as the stream
  proxy.set({});
  const auto client = come_back(proxy.port());
  ASSERT_TRUE(client);
  follow(*client, mirror_);
}

TEST_F(ProxyTest, AStalledLineHoldsUpNobodyElse) {
  begin();
  step(30);
  CuttingProxy proxy(server_.port());
  proxy.set({.stall_after_bytes = 2000});
  std::vector<std::unique_ptr<StreamClient>> stalled;
  while (stalled.size() < 10) stalled.push_back(come_back(proxy.port()));
  const auto direct = come_back(server_.port());
  step(60);
  follow(*direct, mirror_);
}

}  // namespace
}  // namespace flogmap
