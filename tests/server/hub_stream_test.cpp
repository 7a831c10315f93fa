// The stream over real sockets: rules 1, 2, 4, 5, 6 and 7 of the interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "flogmap/v1/stream.pb.h"
#include "tests/server/stream_fixture.hpp"

namespace flogmap {
namespace {

using namespace std::chrono_literals;

TEST_F(StreamTest, TheClientEndsWithTheServersTilesByteForByte) {
  begin();
  step(40);
  StreamClient client(server_.port());
  TileMirror mirror;
  greet(client);
  follow(client, mirror);
  step(40);
  follow(client, mirror);
  EXPECT_EQ(mirror.complete_revision(), truth_->revision());
}

TEST_F(StreamTest, ResumingCostsOnlyTheChangedTiles) {
  begin();
  step(80);
  TileMirror mirror;
  {
    StreamClient client(server_.port());
    greet(client);
    follow(client, mirror);
  }
  const std::uint64_t everything = mirror.batch_bytes();
  step(4);
  mirror.reconnect();
  StreamClient client(server_.port());
  client.send(hello_frame(Resume{mirror.epoch(), mirror.complete_revision(), mirror.path_ns().size()}));
  client.send(subscribe_frame(kEvidence));
  follow(client, mirror);
  EXPECT_LT(mirror.batch_bytes(), everything);
  EXPECT_GT(mirror.batch_bytes(), 0U);
}

TEST_F(StreamTest, AResetEmptiesTheClientAndFillsItAnew) {
  begin();
  step(20);
  StreamClient client(server_.port());
  TileMirror mirror;
  greet(client);
  follow(client, mirror);
  begin("0000000000000002");
  step(8);
  follow(client, mirror);
  EXPECT_EQ(mirror.epoch(), "0000000000000002");
}

TEST_F(StreamTest, AnotherEpochIsAnsweredByAReset) {
  begin();
  step(4);
  StreamClient client(server_.port());
  client.send(hello_frame(Resume{"ffffffffffffffff", 99, 5}));
  TileMirror mirror;
  EXPECT_EQ(mirror.take(client.read().value()), TileMirror::Effect::welcome);
  EXPECT_EQ(mirror.take(client.read().value()), TileMirror::Effect::reset);
}

TEST_F(StreamTest, OneWhoDoesNotReadHoldsUpNobody) {
  begin();
  StreamClient::Options narrow;
  narrow.receive_buffer_bytes = 4096;
  StreamClient sleeper(server_.port(), narrow);
  greet(sleeper);
  step(100);
  StreamClient client(server_.port());
  TileMirror mirror;
  greet(client);
  const auto start = std::chrono::steady_clock::now();
  step(100);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);  // publishing does not wait either
  follow(client, mirror);
}

TEST_F(StreamTest, PosesPicturesCellsAndPongsArrive) {
  begin();
  step(8);
  StreamClient client(server_.port());
  Subscribe wish = kEvidence;
  wish.images = {{ImageStream::left, 10, 320}, {ImageStream::disparity, 10, 0}};
  wish.features = true;
  client.send(hello_frame());
  client.send(subscribe_frame(wish));
  client.send(inspect_frame(0.5, 0.5));
  client.send(ping_frame(4711));
  std::set<int> kinds;
  TileMirror mirror;
  for (int i = 0; i < 200 && kinds.size() < 7; ++i) {
    if (i % 10 == 0) {
      server_.hub().publish_pictures(walk_.pictures());
      step(1);
    }
    const auto message = client.read(200ms);
    v1::ServerMessage parsed;
    if (!message || !parsed.ParseFromString(*message)) continue;
    mirror.take(*message);
    client.send(ack_frame(mirror.batch_bytes()));
    const bool picture = parsed.has_image_frame();
    if (picture && parsed.image_frame().stream() == v1::IMAGE_STREAM_LEFT) {
      EXPECT_EQ(parsed.image_frame().width(), 320U);
      EXPECT_EQ(parsed.image_frame().full_width(), 752U);
    }
    EXPECT_EQ(parsed.has_pong() ? parsed.pong().nonce() : 4711U, 4711U);
    const std::set<int> wanted{v1::ServerMessage::kWelcome,  v1::ServerMessage::kPose,
                               v1::ServerMessage::kFeatures, v1::ServerMessage::kCellColumn,
                               v1::ServerMessage::kPong,     v1::ServerMessage::kStatus};
    if (picture && parsed.image_frame().stream() == v1::IMAGE_STREAM_DISPARITY) kinds.insert(1000);
    if (wanted.count(parsed.message_case()) > 0) kinds.insert(parsed.message_case());
  }
  EXPECT_EQ(kinds.size(), 7U);
  EXPECT_TRUE(server_.hub().wants_pictures());
}

TEST_F(StreamTest, BadFramesAreClosedWithTheirCode) {
  begin();
  struct Case {
    std::string name, frame;
    bool binary, after_hello;
    int code;
  };
  const std::vector<Case> cases{{"unknown version", hello_frame(9), true, false, 4002},
                                {"before Hello", ping_frame(1), true, false, 4003},
                                {"second Hello", hello_frame(), true, true, 4003},
                                {"text", "hello", false, true, 4003},
                                {"garbage", "\xff\xff\xff\xff\xff", true, true, 4003},
                                {"empty", "", true, true, 4003},
                                {"acknowledges too much", ack_frame(1U << 30U), true, true, 4003},
                                {"too long", std::string(65537, 'x'), true, true, 1009}};
  for (const Case& c : cases) {
    StreamClient client(server_.port());
    if (c.after_hello) client.send(hello_frame());
    client.send(c.frame, c.binary);
    EXPECT_EQ(client.wait_for_close(), c.code) << c.name;
  }
}

TEST_F(StreamTest, NoHelloInFiveSecondsIsClosed) {
  begin();
  StreamClient client(server_.port());
  EXPECT_EQ(client.wait_for_close(9s), 4000);
}

TEST_F(StreamTest, DrainingSaysGoodbyeAndCloses) {
  begin();
  step(4);
  StreamClient client(server_.port());
  greet(client);
  TileMirror mirror;
  follow(client, mirror);
  server_.hub().drain("shutting down");
  TileMirror::Effect last = TileMirror::Effect::other;
  while (const auto message = client.read()) last = mirror.take(*message);
  EXPECT_EQ(last, TileMirror::Effect::goodbye);
  EXPECT_EQ(client.close_code(), 1001);
  server_.join();
}

TEST_F(StreamTest, WhileItDrainsTheServerSaysSoToEverybody) {
  begin();
  StreamClient::Options narrow;
  narrow.receive_buffer_bytes = 4096;
  StreamClient sleeper(server_.port(), narrow);  // keeps the server from ending at once
  greet(sleeper);
  step(100);
  server_.hub().drain("shutting down");
  HttpReply ready = http(server_.port(), "GET", "/readyz");
  for (int i = 0; i < 100 && ready.status == 200; ++i) ready = http(server_.port(), "GET", "/readyz");
  EXPECT_EQ(ready.status, 503);
  EXPECT_THAT(ready.body, ::testing::HasSubstr("shutting down"));
  const HttpReply map = http(server_.port(), "GET", "/api/v1/maps/live");
  EXPECT_EQ(map.status, 503);
  EXPECT_EQ(map.headers.count("retry-after"), 1U);
  EXPECT_THROW(StreamClient late(server_.port()), std::runtime_error);
  server_.join();
}

TEST_F(StreamTest, StrangersAreRefusedBeforeTheStreamOpens) {
  begin();
  const auto status = [&](const HttpHeaders& more) {
    HttpHeaders headers{{"Connection", "Upgrade"},
                        {"Upgrade", "websocket"},
                        {"Sec-WebSocket-Version", "13"},
                        {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="},
                        {"Sec-WebSocket-Protocol", "flogmap.v1.proto"}};
    headers.insert(headers.end(), more.begin(), more.end());
    return http(server_.port(), "GET", "/api/v1/stream", headers).status;
  };
  EXPECT_EQ(status({{"Origin", "http://evil.example"}}), 403);
  EXPECT_EQ(status({{"Host", "evil.example"}}), 403);
  EXPECT_EQ(status({{"Sec-WebSocket-Protocol", "chat"}}), 400);
  EXPECT_EQ(status({{"Origin", "http://127.0.0.1:" + std::to_string(server_.port())}}), 101);
}

}  // namespace
}  // namespace flogmap
