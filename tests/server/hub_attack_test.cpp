// Ten thousand malformed requests and frames of every class: each gets its code, and the server serves on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <random>
#include <thread>

#include "tests/server/client_frames.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/raw_stream.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr int kRequestsOfEach = 400;
constexpr int kFramesOfEach = 270;

ServeOptions many_connections() {
  ServeOptions options;
  options.max_connections = options.max_connections_per_address = 256;
  return options;
}

class Attack : public ::testing::Test {
 protected:
  Attack() : server_(many_connections()) {
    SyntheticWalk walk;
    server_.hub().begin(walk.begin("0123456789abcdef", "started"));
    for (int i = 0; i < 20; ++i) server_.hub().publish(walk.revision(), walk.step());
    while (http(server_.port(), "GET", "/api/v1/maps/live").status != 200)
      std::this_thread::sleep_for(milliseconds(5));
  }

  [[nodiscard]] std::string host() const {
    return "Host: 127.0.0.1:" + std::to_string(server_.port()) + "\r\n";
  }
  std::string noise(std::size_t most, bool printable) {
    std::string bytes(1 + random_() % most, '\0');
    for (char& c : bytes) c = static_cast<char>(printable ? '!' + random_() % 94 : random_() % 256);
    return bytes;
  }
  std::string random_protobuf() {
    std::string frame = subscribe_frame({{{}, Planes::evidence}, {}, 20, true});
    for (int i = 0; i < 4; ++i) frame[random_() % frame.size()] = static_cast<char>(random_());
    return frame;
  }

  /// The status of the answer to these bytes; 0: closed without one.
  int status_after(const std::string& bytes) {
    RawConnection connection(server_.port());
    connection.send(bytes);
    const std::string answer = connection.read_until("\r\n");
    return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
  }

  LoopbackHub server_;
  std::mt19937 random_{20261122};
};

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
      {"not JSON",
       [&] {
         return "PATCH /api/v1/playback HTTP/1.1\r\n" + host() +
                "Content-Type: application/json\r\nContent-Length: 9\r\n\r\n{\"rate\":}";
       },
       400},
  };
  for (const RequestClass& one : classes) {
    for (int i = 0; i < kRequestsOfEach; ++i) {
      const std::string bytes = one.make();
      ASSERT_THAT(status_after(bytes), one.status) << one.name << ": " << ::testing::PrintToString(bytes);
    }
  }
  EXPECT_EQ(http(server_.port(), "GET", "/readyz").status, 200);
}

struct FrameClass {
  std::string name;
  std::function<std::string()> make;
  ::testing::Matcher<int> code;
};

TEST_F(Attack, EveryMalformedFrameGetsItsCode) {
  const std::string hello = bytes_of({0x82, hello_frame()});
  const auto frame = [](std::uint8_t first, std::string payload) {
    return bytes_of({first, std::move(payload)});
  };
  const std::vector<FrameClass> classes{
      {"not masked",
       [&] {
         return bytes_of({0x82, hello_frame(), false});
       },
       1002},
      {"reserved bit", [&] { return frame(static_cast<std::uint8_t>(0x82 | 0x10U << random_() % 3), "x"); },
       1002},
      {"reserved opcode", [&] { return frame(static_cast<std::uint8_t>(0x83 + random_() % 5), "x"); }, 1002},
      {"long ping", [&] { return frame(0x89, std::string(126, 'p')); }, 1002},
      {"ping in parts", [&] { return frame(0x09, "p"); }, 1002},
      {"continues nothing", [&] { return frame(0x80, noise(20, false)); }, 1002},
      {"begins twice", [&] { return frame(0x02, "a") + frame(0x82, "b"); }, 1002},
      {"bad close code", [&] { return frame(0x88, std::string("\x03\xed", 2)); }, 1002},
      {"too long",
       [&] {
         return bytes_of({0x82, std::string(70000, 'x')});
       },
       1009},
      {"claims to be huge",
       [&] {
         return bytes_of({0x82, "x", true, std::uint64_t{1} << 40U});
       },
       1009},
      {"long in parts",
       [&] { return frame(0x02, std::string(40000, 'x')) + frame(0x80, std::string(40000, 'x')); }, 1009},
      {"text", [&] { return hello + frame(0x81, noise(50, true)); }, 4003},
      {"noise", [&] { return hello + frame(0x82, "\xff" + noise(300, false)); }, 4003},
      {"before Hello", [&] { return frame(0x82, ping_frame(random_())); }, 4003},
      {"second Hello", [&] { return hello + hello; }, 4003},
      {"unknown version",
       [&] { return frame(0x82, hello_frame(static_cast<std::uint32_t>(2 + random_() % 1000))); }, 4002},
      {"acknowledges too much", [&] { return hello + frame(0x82, ack_frame(1U << 30U)); }, 4003},
      {"a flipped Subscribe",
       [&] { return hello + frame(0x82, random_protobuf()) + frame(0x88, "\x03\xe8"); }, AnyOf(4003, 1000)},
  };
  for (const FrameClass& one : classes) {
    for (int i = 0; i < kFramesOfEach; ++i) {
      ASSERT_THAT(close_code_after(server_.port(), one.make()), one.code) << one.name << " " << i;
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
