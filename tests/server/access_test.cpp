#include "server/access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace flogmap {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const Access::Time kNow{1h};

ServeOptions with_tokens() {
  ServeOptions options;
  options.tokens = {{Role::view, "view-secret"}, {Role::control, "control-secret"}};
  return options;
}

std::string complaint_of(const ServeOptions& options) {
  try {
    check(options);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Access, WithoutTokensEverybodyHasControl) { EXPECT_EQ(Access({}).role_of("", "", kNow), Role::control); }

TEST(Access, WithTokensOnlyTheyCount) {
  const Access access(with_tokens());
  EXPECT_EQ(access.role_of("", "", kNow), Role::none);
  EXPECT_EQ(access.role_of("Bearer view-secret", "", kNow), Role::view);
  EXPECT_EQ(access.role_of("Bearer control-secret", "", kNow), Role::control);
  for (const char* wrong :
       {"Bearer ", "Bearer view-secre", "Bearer view-secrett", "view-secret", "Basic view-secret"}) {
    EXPECT_EQ(access.role_of(wrong, "", kNow), Role::none) << wrong;
  }
}

TEST(Access, ALoginLastsItsTimeAndNoLonger) {
  Access access(with_tokens());
  EXPECT_FALSE(access.log_in("guess", kNow));
  const std::string name = access.log_in("control-secret", kNow).value();
  const std::string cookie = "theme=dark; flogmap_session=" + name;
  EXPECT_EQ(access.role_of("", cookie, kNow), Role::control);
  EXPECT_EQ(access.role_of("", cookie, kNow + Access::kLoginLasts), Role::none);
  EXPECT_EQ(access.role_of("", "xflogmap_session=" + name, kNow), Role::none);
  access.log_out(cookie);
  EXPECT_EQ(access.role_of("", cookie, kNow), Role::none);
}

TEST(Access, LoginsDoNotPileUp) {
  Access access(with_tokens());
  const std::string first = access.log_in("view-secret", kNow).value();
  for (int i = 1; i <= 1024; ++i) access.log_in("view-secret", kNow + std::chrono::seconds(i));
  EXPECT_EQ(access.role_of("", "flogmap_session=" + first, kNow), Role::none);
}

TEST(Access, WrongSecretsRunOutForAMinute) {
  Access access(with_tokens());
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(access.may_try("10.0.0.1", kNow));
    access.count_failure("10.0.0.1", kNow);
  }
  EXPECT_FALSE(access.may_try("10.0.0.1", kNow + 59s));
  EXPECT_TRUE(access.may_try("10.0.0.2", kNow));
  EXPECT_TRUE(access.may_try("10.0.0.1", kNow + 60s));
}

TEST(Access, OnlyOwnNamesAreAnsweredTo) {
  ServeOptions options;
  options.allow_hosts = {"robot.local", "maps.example:8443"};
  const Access access(options);
  for (const char* host : {"localhost", "localhost:8080", "127.0.0.1:8080", "[::1]:8080", "192.168.4.1:8080",
                           "robot.local", "robot.local:99", "maps.example:8443"}) {
    EXPECT_TRUE(access.host_allowed(host, "192.168.4.1")) << host;
  }
  for (const char* host : {"", "evil.example", "localhost.evil.example", "192.168.4.2",
                           "127.0.0.1.evil.example:80", "maps.example:1", "["}) {
    EXPECT_FALSE(access.host_allowed(host, "192.168.4.1")) << host;
  }
}

TEST(Access, OnlyThePagesOwnOriginAndAllowedOnesPass) {
  ServeOptions options;
  options.allow_origins = {"https://maps.example"};
  const Access access(options);
  EXPECT_TRUE(access.origin_allowed("", "localhost:8080", false));
  EXPECT_TRUE(access.origin_allowed("http://localhost:8080", "localhost:8080", false));
  EXPECT_TRUE(access.origin_allowed("https://localhost:8080", "localhost:8080", true));
  EXPECT_TRUE(access.origin_allowed("https://maps.example", "localhost:8080", false));
  for (const char* origin : {"null", "http://localhost", "http://localhost:8081", "https://localhost:8080",
                             "http://localhost:8080.evil.example", "https://maps.example.evil"}) {
    EXPECT_FALSE(access.origin_allowed(origin, "localhost:8080", false)) << origin;
  }
}

TEST(ConnectionLimit, PlacesComeBackWithTheirTickets) {
  ConnectionLimit limit(3, 2);
  auto a = limit.admit("a"), b = limit.admit("a");
  EXPECT_FALSE(limit.admit("a"));
  auto c = limit.admit("c");
  EXPECT_FALSE(limit.admit("d"));
  a.reset();
  EXPECT_TRUE(limit.admit("d"));
  EXPECT_EQ(limit.num_open(), 2);
}

TEST(ServeOptions, AnOpenAddressNeedsTokens) {
  ServeOptions options;
  EXPECT_EQ(complaint_of(options), "");
  options.listen_address = "0.0.0.0";
  EXPECT_THAT(complaint_of(options), HasSubstr("0.0.0.0 can be reached by others"));
  options.insecure_no_auth = true;
  EXPECT_EQ(complaint_of(options), "");
  options.insecure_no_auth = false;
  options.tokens = with_tokens().tokens;
  EXPECT_EQ(complaint_of(options), "");
  options.listen_address = "localhost";
  EXPECT_THAT(complaint_of(options), HasSubstr("numeric address"));
}

TEST(Tokens, AFileSaysWhichLineIsWrong) {
  const std::string path = ::testing::TempDir() + "tokens";
  std::ofstream(path) << "# who may do what\nview  view-secret\n\ncontrol control-secret # the operator\n";
  const auto tokens = read_tokens(path);
  ASSERT_EQ(tokens.size(), 2U);
  EXPECT_EQ(tokens[1].role, Role::control);
  EXPECT_EQ(tokens[1].secret, "control-secret");
  const auto complaint = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      read_tokens(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint("view view-secret\nadmin some-secret\n"),
              HasSubstr(":2: role must be view or control"));
  EXPECT_THAT(complaint("view short\n"), HasSubstr(":1: a token needs at least 8"));
  EXPECT_THAT(complaint("# nothing\n"), HasSubstr("holds no token"));
  EXPECT_THAT(complaint("view view-secret extra\n"), HasSubstr(":1: more than"));
  EXPECT_THAT(complaint("view same-secret\ncontrol same-secret\n"), HasSubstr("each role needs its own"));
}

}  // namespace
}  // namespace flogmap
