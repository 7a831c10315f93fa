// Reading requests: URLs, Accept, If-None-Match, routes.
#include "server/http_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/router.hpp"
#include "server/palette.hpp"

namespace flogmap {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Target, PathAndQueryAreDecoded) {
  ApiRequest request;
  ASSERT_TRUE(parse_target("/a%20b/c?x=-1.5&name=two+words&flag&empty=", request));
  EXPECT_EQ(request.path, "/a b/c");
  EXPECT_THAT(request.query,
              ElementsAre(Pair("x", "-1.5"), Pair("name", "two words"), Pair("flag", ""), Pair("empty", "")));
  EXPECT_EQ(request.parameter("x"), "-1.5");
  EXPECT_EQ(request.parameter("y"), std::nullopt);
}

TEST(Target, AnAbsoluteUrlBringsItsHost) {
  for (const std::string target : {"http://host:80/a?x=1", "HTTPS://host:80/a?x=1"}) {
    ApiRequest request;
    request.host = "other";
    ASSERT_TRUE(parse_target(target, request)) << target;
    EXPECT_EQ(request.host, "host:80");
    EXPECT_EQ(request.path, "/a");
    EXPECT_EQ(request.parameter("x"), "1");
  }
  ApiRequest bare;
  ASSERT_TRUE(parse_target("http://host?x=1", bare));
  EXPECT_EQ(bare.path, "/");
  EXPECT_EQ(bare.parameter("x"), "1");
  for (const std::string target :
       {"http", "https", "http:", "http:/", "http://", "http:///a", "ftp://host/a", "://host/a"}) {
    ApiRequest request;
    request.host = "other";
    (void)parse_target(target, request);  // must read nothing beyond its end
    EXPECT_EQ(request.host, "other") << target;
  }
}

TEST(Target, BrokenEscapesAndHiddenEndsAreRefused) {
  for (const char* target : {"", "a", "*", "/%", "/%4", "/%zz", "/a%00b", "/?x=%"}) {
    ApiRequest request;
    EXPECT_FALSE(parse_target(target, request)) << target;
  }
}

TEST(Accept, TheBestLikedTypeWins) {
  const std::vector<std::string_view> offered{"image/png", "application/x-protobuf", "application/json"};
  EXPECT_EQ(negotiate("", offered), "image/png");
  EXPECT_EQ(negotiate("*/*", offered), "image/png");
  EXPECT_EQ(negotiate("application/*", offered), "application/x-protobuf");
  EXPECT_EQ(negotiate("image/*;q=0.3, application/json;q=0.8", offered), "application/json");
  EXPECT_EQ(negotiate("image/png;q=0, */*;q=0.1", offered), "application/x-protobuf");
  EXPECT_EQ(negotiate("text/html", offered), std::nullopt);
}

TEST(Etag, MatchesItselfInAListWeakOrAnything) {
  for (const char* header : {"\"a-1-x\"", "\"b\", \"a-1-x\"", "W/\"a-1-x\"", "*"}) {
    EXPECT_TRUE(etag_matches(header, "\"a-1-x\"")) << header;
  }
  EXPECT_FALSE(etag_matches("\"a-2-x\"", "\"a-1-x\""));
  EXPECT_FALSE(etag_matches("*", ""));
}

TEST(Problem, IsJsonWhateverTheDetailHolds) {
  const ApiResponse response = problem(400, "bad-parameter", "got '\xff\xfe\"'", "x");
  const auto json = nlohmann::json::parse(*response.body);
  EXPECT_EQ(json["status"], 400);
  EXPECT_EQ(json["title"], "Bad Request");
  EXPECT_EQ(json["parameter"], "x");
}

TEST(Route, APatternFitsItsPathsAndNoOthers) {
  std::vector<std::string> captures;
  EXPECT_TRUE(path_fits("/maps/{}/tiles/{}", "/maps/live/tiles/-3", captures));
  EXPECT_THAT(captures, ElementsAre("live", "-3"));
  for (const char* path :
       {"/maps/live/tiles", "/maps/live/tiles/", "/maps//tiles/1", "/maps/live/tiles/1/2", "/other"}) {
    captures.clear();
    EXPECT_FALSE(path_fits("/maps/{}/tiles/{}", path, captures)) << path;
  }
}

TEST(Palette, RunsFromDarkToLightAndGreyFromWhiteToBlack) {
  const auto luminance = [](Colour c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; };
  for (const Palette palette : {Palette::cividis, Palette::viridis}) {
    for (int i = 1; i < 256; ++i) {
      EXPECT_GE(luminance(table_of(palette)[i]) + 0.8, luminance(table_of(palette)[i - 1])) << i;
    }
  }
  EXPECT_EQ(table_of(Palette::grey)[0], (Colour{255, 255, 255}));
  EXPECT_EQ(table_of(Palette::grey)[255], (Colour{0, 0, 0}));
  EXPECT_EQ(palette_named("rainbow"), std::nullopt);
}

}  // namespace
}  // namespace flogmap
