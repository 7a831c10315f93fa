// HTTP as promised: status, headers and bodies of every kind of request, against a real hub.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/server/loopback_hub.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

void fill(LoopbackHub& server) {
  SyntheticWalk walk;
  server.hub().begin(walk.begin("0123456789abcdef", "started"));
  for (int i = 0; i < 20; ++i) {
    auto tiles = walk.step();
    if (!tiles.empty()) server.hub().publish(walk.revision(), std::move(tiles));
    server.hub().publish_tracking(walk.tracking());
  }
  server.hub().publish_pictures(walk.pictures());
  for (int i = 0; i < 400; ++i) {
    const HttpReply reply = http(server.port(), "GET", "/api/v1/maps/live");
    if (reply.status == 200 && json::parse(reply.body)["rev"] == walk.revision()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  FAIL() << "the hub does not take in what is published";
}

class HttpTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    server_ = std::make_unique<LoopbackHub>();
    fill(*server_);
  }
  static void TearDownTestSuite() { server_.reset(); }

  static HttpReply get(const std::string& target, const HttpHeaders& headers = {}) {
    return http(server_->port(), "GET", target, headers);
  }
  /// A tile of level 0 that exists.
  static std::string a_tile() {
    const json changes = json::parse(get("/api/v1/maps/live/changes").body);
    for (const auto& tile : changes["tiles"]) {
      if (tile["level"] == 0)
        return std::to_string(tile["x"].get<int>()) + "/" + std::to_string(tile["y"].get<int>());
    }
    return "";
  }

  static std::unique_ptr<LoopbackHub> server_;
};

std::unique_ptr<LoopbackHub> HttpTest::server_;

TEST_F(HttpTest, EveryRequestGetsTheRightStatus) {
  struct Case {
    std::string method, target;
    int status;
    HttpHeaders headers;
    std::string body;
  };
  const std::string json_type = "application/json";
  const std::vector<Case> cases{
      {"GET", "/healthz", 200, {}, ""},
      {"GET", "/readyz", 200, {}, ""},
      {"GET", "/metrics", 200, {}, ""},
      {"GET", "/", 200, {}, ""},
      {"GET", "/docs", 200, {}, ""},
      {"GET", "/openapi.yaml", 200, {}, ""},
      {"GET", "/api/v1/maps", 200, {}, ""},
      {"GET", "/api/v1/maps/none", 404, {}, ""},
      {"GET", "/api/v1/maps/live/cell?x=0.5&y=-0.25", 200, {}, ""},
      {"GET", "/api/v1/maps/live/cell?x=0.5", 400, {}, ""},
      {"GET", "/api/v1/maps/live/cell?x=nan&y=0", 400, {}, ""},
      {"GET", "/api/v1/maps/live/cell?x=1e300&y=0", 400, {}, ""},
      {"GET", "/api/v1/maps/live/cell?x=%zz&y=0", 400, {}, ""},
      {"GET", "/api/v1/maps/live/layers/fused/tiles/0/9999/9999", 204, {}, ""},
      {"GET", "/api/v1/maps/live/layers/7/tiles/0/0/0", 404, {}, ""},
      {"GET", "/api/v1/maps/live/layers/0/tiles/6/0/0", 400, {}, ""},
      {"GET", "/api/v1/maps/live/layers/0/tiles/0/0/x", 400, {}, ""},
      {"GET", "/api/v1/maps/live/layers/0/tiles/0/0/0?style=pretty", 400, {}, ""},
      {"GET", "/api/v1/maps/live/layers/0/tiles/0/0/0?palette=rainbow", 400, {}, ""},
      {"GET", "/api/v1/maps/live/layers/0/tiles/0/0/0?f=gif", 400, {}, ""},
      {"GET", "/api/v1/maps/live/layers/0/tiles/0/0/0", 406, {{"Accept", "image/gif"}}, ""},
      {"GET", "/api/v1/maps/live/changes?since=-1", 400, {}, ""},
      {"GET", "/api/v1/maps/live/changes?epoch=other", 409, {}, ""},
      {"GET", "/api/v1/maps/live/changes?bbox=1,2,3", 400, {}, ""},
      {"GET", "/api/v1/maps/live/image.png", 200, {}, ""},
      {"GET", "/api/v1/maps/live/image.png?bbox=-1000,-1000,1000,1000", 422, {}, ""},
      {"GET", "/api/v1/maps/live/image.png?bbox=0,0,0.02,1000000&width=1", 422, {}, ""},
      {"GET", "/api/v1/maps/live/image.png?bbox=0,0,1000000,0.02&width=16384", 200, {}, ""},
      {"GET", "/api/v1/maps/live/trajectory", 200, {}, ""},
      {"GET", "/api/v1/maps/live/trajectory", 200, {{"Accept", "APPLICATION/Json"}}, ""},
      {"GET", "http://localhost/api/v1/maps", 200, {}, ""},
      {"GET", "http://localhost?x=1", 200, {}, ""},
      {"GET", "http://evil.example/api/v1/maps", 403, {}, ""},
      {"GET", "/api/v1/maps", 403, {{"Host", "localhost:abc"}}, ""},
      {"GET", "/api/v1/maps/live/trajectory?format=xml", 400, {}, ""},
      {"GET", "/api/v1/maps/live/export", 400, {}, ""},
      {"GET", "/api/v1/maps/live/export?format=doc", 400, {}, ""},
      {"GET", "/api/v1/maps/live/export?format=tum", 200, {}, ""},
      {"GET", "/api/v1/frames/left/latest", 200, {}, ""},
      {"GET", "/api/v1/frames/up/latest", 404, {}, ""},
      {"GET", "/api/v1/config", 200, {}, ""},
      {"GET", "/api/v1/calibration", 200, {}, ""},
      {"GET", "/api/v1/stream", 400, {}, ""},
      {"GET", "/../../etc/passwd", 404, {}, ""},
      {"GET", "/%2e%2e/%2e%2e/etc/passwd", 404, {}, ""},
      {"GET", "/nothing", 404, {}, ""},
      {"POST", "/api/v1/maps", 405, {}, ""},
      {"DELETE", "/api/v1/maps/live", 405, {}, ""},
      {"OPTIONS", "/api/v1/playback", 204, {}, ""},
      {"POST", "/api/v1/session:resume", 409, {}, ""},
      {"POST", "/api/v1/playback:step", 409, {}, ""},
      {"PATCH", "/api/v1/playback", 415, {{"Content-Type", "text/plain"}}, "{}"},
      {"PATCH", "/api/v1/playback", 400, {{"Content-Type", json_type}}, "{"},
      {"PATCH", "/api/v1/playback", 422, {{"Content-Type", json_type}}, R"({"rate":-1})"},
      {"PATCH", "/api/v1/playback", 422, {{"Content-Type", json_type}}, R"({"speed":1})"},
      {"PATCH", "/api/v1/playback", 200, {{"Content-Type", json_type}}, R"({"rate":2})"},
      {"PATCH", "/api/v1/playback", 200, {{"Content-Type", "Application/JSON"}}, R"({"rate":2})"},
      {"POST", "/api/v1/maps/live/tiles:batchGet", 415, {}, "{}"},
      {"POST", "/api/v1/maps/live/tiles:batchGet", 422, {{"Content-Type", json_type}}, "{}"},
      {"POST", "/api/v1/maps/live/tiles:batchGet", 200, {{"Content-Type", json_type}}, R"({"tiles":[]})"},
      {"POST", "/api/v1/maps/live/route", 422, {{"Content-Type", json_type}}, R"({"from":[0,0]})"},
      {"POST",
       "/api/v1/maps/live/route",
       422,
       {{"Content-Type", json_type}},
       R"({"from":[900,0],"to":[0,0]})"},
      {"POST",
       "/api/v1/maps/live/route",
       422,
       {{"Content-Type", json_type}},
       R"({"from":"kitchen","to":[0,0]})"},
      {"GET", std::string("/").append(3000, 'a'), 414, {}, ""},
      {"GET", "/", 431, {{"X-Long", std::string(9000, 'a')}}, ""},
      {"POST", "/api/v1/login", 413, {{"Content-Type", json_type}}, std::string(70000, ' ')},
      {"GET", "/api/v1/maps", 403, {{"Host", "evil.example"}}, ""},
      {"POST", "/api/v1/session:pause", 403, {{"Origin", "http://evil.example"}}, ""},
  };
  for (const Case& c : cases) {
    const HttpReply reply = http(server_->port(), c.method, c.target, c.headers, c.body);
    const std::string name = c.method + " " + c.target.substr(0, 80);
    EXPECT_EQ(reply.status, c.status) << name << "\n" << reply.body.substr(0, 200);
    if (reply.status < 400) continue;
    EXPECT_EQ(reply.headers.at("content-type"), "application/problem+json") << name;
    const json problem = json::parse(reply.body, nullptr, false);
    for (const char* field : {"type", "title", "status", "detail", "code"})
      EXPECT_TRUE(problem.contains(field)) << name;
  }
}

TEST_F(HttpTest, HowFarApartLeftAndRightWereTakenIsTold) {
  StatusReport report;
  report.skew = PairSkew{.histogram = {}, .allowed_ms = 5, .num_dropped = 1};
  for (const std::int64_t skew_us : {-300, 50, 300, 7000}) report.skew->histogram.add(skew_us * 1000);
  server_->hub().publish_status(report);
  json skew;
  for (int i = 0; i < 500 && !skew.is_object(); ++i) {  // it takes its way through the mailbox
    skew = json::parse(get("/api/v1/session").body)["pair_skew"];
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_TRUE(skew.is_object());
  EXPECT_NEAR(skew["mean_ms"], (0.3 + 0.05 + 0.3 + 7) / 4, 1e-9);
  EXPECT_NEAR(skew["largest_ms"], 7, 1e-9);
  EXPECT_EQ(skew["dropped_pairs"], 1);
  EXPECT_EQ(skew["histogram"][0], json({{"up_to_ms", 0.1}, {"pairs", 1}}));
  EXPECT_EQ(skew["histogram"][2], json({{"up_to_ms", 0.5}, {"pairs", 2}}));
  EXPECT_EQ(skew["histogram"].back(), json({{"up_to_ms", nullptr}, {"pairs", 0}}));
  for (int i = 0; i < 2; ++i) {  // reading them twice does not count them twice
    const std::string metrics = get("/metrics").body;
    EXPECT_THAT(metrics, HasSubstr("flogmap_pair_skew_seconds_bucket{le=\"0.0005\"} 3"));
    EXPECT_THAT(metrics, HasSubstr("flogmap_pair_skew_seconds_count 4"));
    EXPECT_THAT(metrics, HasSubstr("flogmap_pairs_dropped 1"));
  }
}

TEST_F(HttpTest, AnEtagSavesTheBody) {
  const std::string target = "/api/v1/maps/live/layers/fused/tiles/0/" + a_tile();
  const HttpReply first = get(target);
  ASSERT_EQ(first.status, 200);
  EXPECT_EQ(first.headers.at("cache-control"), "private, no-cache");
  EXPECT_THAT(first.headers.at("etag"), StartsWith("\"0123456789abcdef-"));
  const HttpReply again = get(target, {{"If-None-Match", first.headers.at("etag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.body, "");
  EXPECT_EQ(again.headers.at("etag"), first.headers.at("etag"));
  EXPECT_EQ(get(target, {{"If-None-Match", "\"other\""}}).status, 200);
  EXPECT_NE(get(target + "?style=motion").headers.at("etag"), first.headers.at("etag"));
}

TEST_F(HttpTest, HeadTellsWhatGetWouldSend) {
  const std::string target = "/api/v1/maps/live/layers/0/tiles/0/" + a_tile();
  const HttpReply full = get(target), head = http(server_->port(), "HEAD", target);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.body, "");
  for (const char* name : {"content-length", "content-type", "etag"})
    EXPECT_EQ(head.headers.at(name), full.headers.at(name));
}

TEST_F(HttpTest, ATileComesInTheFormatThatIsAskedFor) {
  const std::string target = "/api/v1/maps/live/layers/fused/tiles/0/" + a_tile();
  EXPECT_THAT(get(target).body, StartsWith("\x89PNG"));
  EXPECT_EQ(get(target, {{"Accept", "application/x-protobuf"}}).headers.at("content-type"),
            "application/x-protobuf");
  EXPECT_EQ(get(target, {{"Accept", "image/gif, application/json;q=0.5"}}).headers.at("content-type"),
            "application/json");
  const json tile = json::parse(get(target + "?f=json").body);
  EXPECT_EQ(tile["layers"].size(), 3U);
  EXPECT_EQ(tile["layers"][0]["E"].size(), 4096U);
}

/// Width and height as a PNG's head says them.
std::pair<int, int> png_size(const std::string& png) {
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = 256 * value + static_cast<unsigned char>(png.at(i));
    return value;
  };
  return {number(16), number(20)};
}

TEST_F(HttpTest, APictureIsAsLargeAsItsBoxAndSaysHowLargeAPixelIs) {
  const double a = json::parse(get("/api/v1/maps/live").body)["cell_size"];
  const auto box = [a](double x0, double y0, double x1, double y1) {
    return "/api/v1/maps/live/image.png?bbox=" + std::to_string(a * x0) + "," + std::to_string(a * y0) + "," +
           std::to_string(a * x1) + "," + std::to_string(a * y1);
  };
  EXPECT_EQ(png_size(get(box(-3, -5, 47, 15)).body), std::pair(50, 20));
  EXPECT_EQ(png_size(get(box(0, 0, 1, 1)).body), std::pair(1, 1));
  EXPECT_EQ(png_size(get(box(0.4, 0.4, 0.6, 1.1)).body), std::pair(1, 2));
  const HttpReply small = get(box(0, 0, 100, 40) + "&width=25");
  EXPECT_EQ(png_size(small.body), std::pair(25, 10));
  EXPECT_NEAR(std::stod(small.headers.at("flogmap-cell-size")), 4 * a, 1e-6);
  EXPECT_NEAR(std::stod(get(box(0, 0, 100, 40)).headers.at("flogmap-cell-size")), a, 1e-6);
}

TEST_F(HttpTest, APictureIsNeverWiderThanAskedFor) {
  for (const int most : {1, 7, 100, 250}) {
    const HttpReply reply = get("/api/v1/frames/disparity/latest?max_width=" + std::to_string(most));
    ASSERT_EQ(reply.status, 200);
    EXPECT_LE(png_size(reply.body).first, most);
  }
}

TEST_F(HttpTest, ChangesNameEveryTileOnce) {
  const json all = json::parse(get("/api/v1/maps/live/changes?limit=10000").body);
  EXPECT_FALSE(all["more"].get<bool>());
  std::uint64_t since = 0;
  std::size_t num_tiles = 0;
  for (bool more = true; more;) {
    const json part =
        json::parse(get("/api/v1/maps/live/changes?limit=3&since=" + std::to_string(since)).body);
    num_tiles += part["tiles"].size();
    ASSERT_GT(part["rev"].get<std::uint64_t>(), since);
    since = part["rev"];
    more = part["more"];
  }
  EXPECT_EQ(num_tiles, all["tiles"].size());
  EXPECT_EQ(since, all["rev"].get<std::uint64_t>());
}

TEST_F(HttpTest, PagesAreShutOffFromElsewhere) {
  const HttpReply page = get("/");
  EXPECT_THAT(page.headers.at("content-security-policy"), HasSubstr("default-src 'self'"));
  EXPECT_EQ(page.headers.at("x-content-type-options"), "nosniff");
  EXPECT_EQ(page.headers.at("x-frame-options"), "DENY");
}

TEST_F(HttpTest, NotAllowedSaysWhatIs) {
  EXPECT_EQ(http(server_->port(), "DELETE", "/api/v1/playback").headers.at("allow"),
            "GET, HEAD, PATCH, OPTIONS");
}

TEST_F(HttpTest, WhatIsNoHttpIsRefused) {
  EXPECT_THAT(raw(server_->port(), "BLA\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(raw(server_->port(), "GET / HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 400"));  // no Host
  EXPECT_THAT(raw(server_->port(), std::string("\x16\x03\x01\x02\x00\x01\x00\x01", 8) + "\r\n\r\n"),
              StartsWith("HTTP/1.1 400"));
}

TEST_F(HttpTest, RequestsInARowAreAnsweredInOrder) {
  const std::string two =
      "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"
      "GET /nothing HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  const std::string replies = raw(server_->port(), two);
  EXPECT_THAT(replies, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(replies, HasSubstr("HTTP/1.1 404"));
}

TEST_F(HttpTest, AHeaderThatNeverEndsIsCutOff) {
  const auto start = std::chrono::steady_clock::now();
  raw(server_->port(), "GET / HTTP/1.1\r\nHost: localhost\r\n");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(7));
}

TEST(Http, BeforeAMapBeginsTheServerSaysSo) {
  LoopbackHub server;
  EXPECT_EQ(http(server.port(), "GET", "/readyz").status, 503);
  EXPECT_THAT(http(server.port(), "GET", "/readyz").body, HasSubstr("has not begun"));
  const HttpReply reply = http(server.port(), "GET", "/api/v1/maps/live");
  EXPECT_EQ(reply.status, 503);
  EXPECT_EQ(reply.headers.count("retry-after"), 1U);
}

TEST(Http, ATakenPortIsOneClearLine) {
  LoopbackHub first;
  ServeOptions options;
  options.port = first.port();
  FakeSession session;
  try {
    const Hub second(options, session, {});
    FAIL() << "two hubs on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()),
              "127.0.0.1:" + std::to_string(first.port()) + " is in use; choose another with --listen");
  }
}

}  // namespace
}  // namespace flogmap
