// Ten thousand malformed requests of every class: each gets its code, and the server serves on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "tests/server/client_frames.hpp"
#include "tests/server/hub_attack.hpp"

namespace flogmap {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using ::testing::HasSubstr;

constexpr int kRequestsOfEach = 310;

struct RequestClass {
  std::string name;
  std::function<std::string()> make;
  ::testing::Matcher<int> status;
};

TEST_F(Attack, EveryMalformedRequestGetsItsStatus) {
  const std::vector<RequestClass> classes{
      {"noise", [&] { return "\x16" + noise(200, false) + "\r\n\r\n"; }, 400},
      {"TLS hello", [&] { return "\x16\x03\x01\x02" + noise(64, false) + "\r\n\r\n"; }, 400},
      {"HTTP/2 preface", [&] { return std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"); }, 400},
      {"unknown version", [&] { return "GET / HTTP/" + noise(3, true) + "\r\n" + host() + "\r\n"; }, 400},
      {"unknown method", [&] { return "BREW /api/v1/maps HTTP/1.1\r\n" + host() + "\r\n"; }, 405},
      {"line break in a name", [&] { return "GET / HTTP/1.1\r\nHo\nst: x\r\n" + host() + "\r\n"; }, 400},
      {"NUL in a value",
       [&] { return "GET / HTTP/1.1\r\n" + host() + "X: a" + std::string(1, '\0') + "\r\n\r\n"; }, 400},
      {"no host", [&] { return std::string("GET /api/v1/maps HTTP/1.1\r\n\r\n"); }, 400},
      {"broken escape", [&] { return "GET /api/%" + noise(1, true) + "! HTTP/1.1\r\n" + host() + "\r\n"; },
       400},
      {"long URL",
       [&] {
         return "GET /" + std::string(2100 + random_() % 4000, 'a') + " HTTP/1.1\r\n" + host() + "\r\n";
       },
       414},
      {"long header",
       [&] { return "GET / HTTP/1.1\r\n" + host() + "X: " + std::string(9000, 'b') + "\r\n\r\n"; }, 431},
      {"long body",
       [&] {
         return "POST /api/v1/login HTTP/1.1\r\n" + host() +
                "Content-Length: " + std::to_string(65537 + random_() % 1000000) + "\r\n\r\nx";
       },
       413},
      {"two lengths",
       [&] {
         return "POST /api/v1/login HTTP/1.1\r\n" + host() +
                "Content-Length: 4\r\nContent-Length: 5\r\n\r\nabcde";
       },
       400},
      {"length and chunks",
       [&] {
         return "POST /api/v1/login HTTP/1.1\r\n" + host() +
                "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n";
       },
       400},
      {"broken chunk",
       [&] {
         return "POST /api/v1/login HTTP/1.1\r\n" + host() + "Transfer-Encoding: chunked\r\n\r\nzz" +
                noise(8, true) + "\r\n";
       },
       400},
      {"not JSON", [&] { return patch("{\"rate\":}"); }, 400},
      {"no object", [&] { return patch(std::to_string(random_())); }, 400},
      {"impossible value", [&] { return patch("{\"rate\":-" + std::to_string(random_()) + "}"); }, 422},
      {"another content type",
       [&] {
         return "POST /api/v1/maps/live/route HTTP/1.1\r\n" + host() + "Content-Type: x/" + word() +
                "\r\nContent-Length: 2\r\n\r\n{}";
       },
       415},
      {"nothing there", [&] { return get("/api/v1/" + word()); }, 404},
      {"no such layer", [&] { return get("/api/v1/maps/live/layers/" + word() + "/tiles/0/0/0"); }, 404},
      {"no such level",
       [&] { return get("/api/v1/maps/live/layers/fused/tiles/" + std::to_string(6 + random_()) + "/0/0"); },
       400},
      {"not a number", [&] { return get("/api/v1/maps/live/cell?x=1&y=" + word()); }, 400},
      {"unknown style", [&] { return get("/api/v1/maps/live/image.png?style=" + word()); }, 400},
      {"another epoch", [&] { return get("/api/v1/maps/live/changes?since=1&epoch=" + word()); }, 409},
      {"not acceptable",
       [&] { return get("/api/v1/maps/live/layers/fused/tiles/0/0/0", "Accept: x/" + word() + "\r\n"); },
       406},
      {"wrong method",
       [&] { return "DELETE /api/v1/session HTTP/1.1\r\n" + host() + "X-Why: " + word() + "\r\n\r\n"; }, 405},
      {"foreign host", [&] { return "GET /api/v1/maps HTTP/1.1\r\nHost: " + word() + ".example\r\n\r\n"; },
       403},
      {"foreign origin",
       [&] {
         return "POST /api/v1/session:pause HTTP/1.1\r\n" + host() + "Origin: http://" + word() +
                ".example\r\nContent-Length: 0\r\n\r\n";
       },
       403},
      {"no WebSocket", [&] { return get("/api/v1/stream", "Upgrade: " + word() + "\r\n"); }, 400},
      {"WebSocket of another version", [&] { return upgrade("Version: 13", "Version: " + word()); }, 400},
      {"WebSocket with a bad key", [&] { return upgrade("dGhlIHNhbXBsZSBub25jZQ==", word()); }, 400},
      {"WebSocket of another protocol", [&] { return upgrade("flogmap.v1.proto", word()); }, 400},
  };
  for (const RequestClass& one : classes) {
    for (int i = 0; i < kRequestsOfEach; ++i) {
      const std::string bytes = one.make();
      ASSERT_THAT(status_after(bytes), one.status) << one.name << ": " << ::testing::PrintToString(bytes);
    }
  }
  EXPECT_EQ(http(server_.port(), "GET", "/readyz").status, 200);
}

TEST_F(Attack, TwoHundredWhoSendAByteAtATimeDelayNobody) {
  std::vector<std::unique_ptr<RawConnection>> slow;
  for (int i = 0; i < 200; ++i) {
    slow.push_back(std::make_unique<RawConnection>(server_.port()));
    slow.back()->send("GET / HTTP/1.1\r\nX-Slow: ");
  }
  std::vector<double> times_ms;
  for (int round = 0; round < 30; ++round) {
    for (const auto& one : slow) one->send("a");
    const auto start = steady_clock::now();
    ASSERT_EQ(http(server_.port(), "GET", "/api/v1/maps/live").status, 200);
    times_ms.push_back(std::chrono::duration<double, std::milli>(steady_clock::now() - start).count());
    std::this_thread::sleep_for(milliseconds(20));
  }
  std::sort(times_ms.begin(), times_ms.end());
  RecordProperty("slowest_ms", std::to_string(times_ms.back()));
  EXPECT_LT(times_ms[times_ms.size() * 9 / 10], 100);
  std::this_thread::sleep_for(milliseconds(5500));  // a byte now and then does not move their deadline
  for (const auto& one : slow) EXPECT_EQ(one->read_to_end(), "");
}

TEST_F(Attack, OneWhoDoesNotReadItsAnswersIsCutOffAfterTenSeconds) {
  const std::size_t answer_bytes = http(server_.port(), "GET", "/openapi.yaml").body.size();
  constexpr std::size_t kAnswers = 1500;  // more than the system's buffers hold
  RawConnection connection(server_.port());
  for (std::size_t i = 0; i < kAnswers; ++i)
    connection.send("GET /openapi.yaml HTTP/1.1\r\n" + host() + "\r\n");
  std::this_thread::sleep_for(milliseconds(11'000));
  EXPECT_LT(connection.read_to_end().size(), kAnswers * answer_bytes / 2);
}

TEST_F(Attack, OneWhoGoesInTheMiddleOfAMessageLeavesNothingBehind) {
  const std::string request = "GET /api/v1/maps/live/image.png HTTP/1.1\r\n" + host() + "\r\n";
  for (int i = 0; i < 500; ++i) {
    RawConnection connection(server_.port());
    const bool stream = random_() % 2 == 0;
    const std::string bytes =
        stream ? upgrade_request(server_.port()) + bytes_of({0x82, hello_frame()}) : request;
    connection.send(bytes.substr(0, 1 + random_() % bytes.size()));
    if (random_() % 2 == 0) connection.reset();
  }
  std::string metrics;
  for (int i = 0; i < 100 && metrics.find("flogmap_viewers 0\n") == std::string::npos; ++i) {
    std::this_thread::sleep_for(milliseconds(100));
    metrics = http(server_.port(), "GET", "/metrics").body;
  }
  EXPECT_THAT(metrics, HasSubstr("flogmap_viewers 0\n"));
}

}  // namespace
}  // namespace flogmap
