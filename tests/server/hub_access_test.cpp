// Tokens, logins and limits, against a real hub.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/loopback_hub.hpp"
#include "tests/server/synthetic_walk.hpp"

namespace flogmap {
namespace {

using ::testing::HasSubstr;

TEST(HubAccess, TokensDecideWhoMayDoWhat) {
  ServeOptions options;
  options.tokens = {{Role::view, "view-secret"}, {Role::control, "control-secret"}};
  LoopbackHub server(options);
  server.hub().begin(SyntheticWalk().begin("0123456789abcdef", "started"));
  const HttpHeaders view{{"Authorization", "Bearer view-secret"}},
      control{{"Authorization", "Bearer control-secret"}};
  const auto status = [&](const char* method, const char* target, const HttpHeaders& headers) {
    return http(server.port(), method, target, headers).status;
  };
  EXPECT_EQ(status("GET", "/healthz", {}), 200);
  EXPECT_EQ(status("GET", "/", {}), 200);  // the page itself holds nothing secret: it asks for the token
  EXPECT_EQ(status("GET", "/api/v1/session", {}), 401);
  EXPECT_EQ(status("GET", "/metrics", {}), 401);
  EXPECT_EQ(status("GET", "/api/v1/session", {{"Authorization", "Bearer wrong"}}), 401);
  EXPECT_EQ(status("GET", "/api/v1/session", view), 200);
  EXPECT_EQ(status("POST", "/api/v1/session:pause", view), 403);
  EXPECT_EQ(status("POST", "/api/v1/session:pause", control), 200);
}

TEST(HubAccess, ALoginGivesACookieThatScriptsCannotRead) {
  ServeOptions options;
  options.tokens = {{Role::view, "view-secret"}};
  LoopbackHub server(options);
  const HttpHeaders form{{"Content-Type", "application/x-www-form-urlencoded"}};
  const HttpReply reply = http(server.port(), "POST", "/api/v1/login", form, "token=view-secret");
  ASSERT_EQ(reply.status, 200);
  EXPECT_EQ(reply.body, R"({"role":"view"})");
  const std::string cookie = reply.headers.at("set-cookie");
  EXPECT_THAT(cookie, HasSubstr("HttpOnly"));
  EXPECT_THAT(cookie, HasSubstr("SameSite=Strict"));
  const std::string pair = cookie.substr(0, cookie.find(';'));
  EXPECT_EQ(http(server.port(), "GET", "/api/v1/session", {{"Cookie", pair}}).status, 200);
  EXPECT_EQ(http(server.port(), "POST", "/api/v1/logout", {{"Cookie", pair}}).status, 200);
  EXPECT_EQ(http(server.port(), "GET", "/api/v1/session", {{"Cookie", pair}}).status, 401);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(http(server.port(), "POST", "/api/v1/login", form, "token=guess").status, 401);
  }
  EXPECT_EQ(http(server.port(), "POST", "/api/v1/login", form, "token=view-secret").status, 429);
}

TEST(HubAccess, TenWrongBearerTokensFromAnAddressAreEnoughForAMinute) {
  ServeOptions options;
  options.tokens = {{Role::view, "view-secret"}};
  LoopbackHub server(options);
  const auto status = [&](const std::string& secret) {
    return http(server.port(), "GET", "/api/v1/version", {{"Authorization", "Bearer " + secret}}).status;
  };
  EXPECT_EQ(status("view-secret"), 200);
  for (int i = 0; i < 10; ++i) EXPECT_NE(status("guess-" + std::to_string(i)), 429);
  EXPECT_EQ(status("view-secret"), 429);
  EXPECT_EQ(http(server.port(), "GET", "/healthz").status, 200);  // who does not guess is served
}

TEST(HubAccess, TooManyConnectionsAreTurnedAway) {
  ServeOptions options;
  options.max_connections_per_address = 2;
  LoopbackHub server(options);
  server.hub().begin(SyntheticWalk().begin("0123456789abcdef", "started"));
  std::vector<std::unique_ptr<StreamClient>> held;
  while (held.size() < 2) {
    try {
      held.push_back(std::make_unique<StreamClient>(server.port()));
    } catch (const std::runtime_error&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  EXPECT_EQ(http(server.port(), "GET", "/healthz").status, 429);
  held.clear();
  int status = 0;
  for (int i = 0; i < 100 && status != 200; ++i) {
    status = http(server.port(), "GET", "/healthz").status;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(status, 200);
}

}  // namespace
}  // namespace flogmap
