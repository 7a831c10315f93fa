// The interface document against the running program: what it says of every path, method and status is so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <functional>
#include <set>
#include <tuple>

#include "tests/camera/small_scene.hpp"
#include "tests/camera/temporary_folder.hpp"
#include "tests/server/client_frames.hpp"
#include "tests/server/contract_cases.hpp"
#include "tests/server/json_schema.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/running_program.hpp"

namespace flogmap {
namespace {

using nlohmann::json;
using ::testing::IsEmpty;

const std::string kView = "Bearer view-secret", kControl = "Bearer control-secret";
/// One program with a small scene, paused once it has a map, views and pictures.
class Contract : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string scene = folder_.write("scene.json", testing::kSmallScene).string();
    program_ = std::make_unique<RunningProgram>(
        std::vector<std::string>{"--source", "sim:" + scene, "--pace", "fast"},
        std::vector<std::string>{"FLOGMAP_VIEW_TOKEN=view-secret", "FLOGMAP_CONTROL_TOKEN=control-secret"});
    document_ = YAML::Load(ask("GET", "/openapi.yaml").body);
    for (int i = 0; i < 600; ++i) {
      const json views = json::parse(ask("GET", "/api/v1/maps/live/views").body, nullptr, false);
      if (views.is_object() && views.contains("views") && views["views"].size() > 2) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ask("POST", "/api/v1/session:pause");
    for (json before; before != progress();) {  // what is under way arrives
      before = progress();
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  }
  static void TearDownTestSuite() { program_.reset(); }

  static HttpReply ask(const std::string& method, const std::string& target, HttpHeaders headers = {},
                       const std::string& body = {}, const std::string& who = kControl) {
    if (!who.empty()) headers.emplace_back("Authorization", who);
    return http(program_->port(), method, target, headers, body);
  }

  static json progress() {
    const json session = json::parse(ask("GET", "/api/v1/session").body);
    return {session["rev"], session["frames"]};
  }
  static std::string a_tile() {
    const json changes = json::parse(ask("GET", "/api/v1/maps/live/changes").body);
    for (const auto& tile : changes["tiles"]) {
      if (tile["level"] == 0)
        return "0/" + std::to_string(tile["x"].get<int>()) + "/" + std::to_string(tile["y"].get<int>());
    }
    return "";
  }
  /// "[x,y]" of the first place that a small robot can reach from the camera.
  static std::string a_free_place() {
    const json path = json::parse(ask("GET", "/api/v1/maps/live/trajectory").body);
    const json at = path["points"][0]["position"];
    const json from = {{"from", {at[0], at[1]}}, {"robot_radius_m", 0.05}};
    const HttpReply reply =
        ask("POST", "/api/v1/maps/live/reachable", {{"Content-Type", kJson}}, from.dump());
    const json area = json::parse(reply.body);
    if (reply.status != 200) throw std::runtime_error(reply.body);
    const int first = area["runs"][0], width = area["width"];
    const double a = area["cell_size"];
    return json{area["origin"][0].get<double>() + (first % width + 0.5) * a,
                area["origin"][1].get<double>() + (first / width + 0.5) * a}
        .dump();
  }
  static YAML::Node operation(const Case& c) {
    for (const auto& described : document_["paths"][c.path]) {
      if (upper(described.first.as<std::string>()) == c.method) return described.second;
    }
    throw std::runtime_error("the document knows no " + c.method + " " + c.path);
  }

  static const testing::TemporaryFolder folder_;
  static std::unique_ptr<RunningProgram> program_;
  static YAML::Node document_;
};

const testing::TemporaryFolder Contract::folder_;
std::unique_ptr<RunningProgram> Contract::program_;
YAML::Node Contract::document_;

/// What an answer that may be kept must stand: asked again it is a 304, HEAD tells its size.
void check_again(const Case& c, const HttpReply& reply, const std::function<HttpReply(Case)>& ask) {
  Case again = c;
  again.headers.emplace_back("If-None-Match", reply.headers.at("etag"));
  const HttpReply same = ask(again);
  EXPECT_EQ(same.status, 304) << c.target;
  EXPECT_EQ(same.headers.at("etag"), reply.headers.at("etag")) << c.target;
  EXPECT_EQ(same.body, "") << c.target;
  EXPECT_FALSE(same.headers.contains("content-length")) << c.target;
}

void check_head(const Case& c, const HttpReply& reply, const std::function<HttpReply(Case)>& ask) {
  Case head = c;
  head.method = "HEAD";
  const HttpReply only_head = ask(head);
  EXPECT_EQ(only_head.status, reply.status) << c.target;
  EXPECT_EQ(only_head.body, "") << c.target;
  EXPECT_EQ(only_head.headers.contains("etag"), reply.headers.contains("etag")) << c.target;
  if (reply.headers.contains("etag")) {
    EXPECT_EQ(only_head.headers.at("content-length"), reply.headers.at("content-length")) << c.target;
  }
}

/// Status, content type, schema and headers as declared.
void check_reply(const YAML::Node& document, const YAML::Node& operation, const Case& c,
                 const HttpReply& reply) {
  const std::string name = c.method + " " + c.target;
  ASSERT_EQ(reply.status, c.status) << name << "\n" << reply.body.substr(0, 300);
  YAML::Node declared = operation["responses"][std::to_string(reply.status)];
  if (!declared && reply.status >= 400) declared.reset(operation["responses"]["default"]);
  ASSERT_TRUE(declared) << name << ": " << reply.status << " is not declared";
  const YAML::Node content = resolved(document, declared)["content"];
  EXPECT_TRUE(reply.headers.contains("cache-control")) << name;
  EXPECT_EQ(reply.headers.at("x-content-type-options"), "nosniff") << name;
  if (!content || reply.status == 204) {
    EXPECT_EQ(reply.body, "") << name;
    return;
  }
  const std::string full_type = reply.headers.at("content-type");
  const std::string type = full_type.substr(0, full_type.find(';'));
  const YAML::Node as_declared = content[type];
  ASSERT_TRUE(as_declared.IsDefined()) << name << ": " << type << " is not declared";
  if (type.find("json") == std::string::npos) return;
  const json value = json::parse(reply.body, nullptr, false);
  ASSERT_FALSE(value.is_discarded()) << name;
  EXPECT_EQ(fault_by_schema(document, as_declared["schema"], value), "") << name;
  if (reply.status >= 400 && type == "application/problem+json") {
    EXPECT_EQ(value["status"], reply.status) << name;
  }
}

using Answers = std::set<std::tuple<std::string, std::string, std::string>>;

/// Not to be had from this program by a request: the opened stream, starting, draining and being overrun
/// (tested elsewhere), an empty map, a source that cannot be moved or reset, a map whose views are gone.
bool out_of_reach(const std::string& method, const std::string& path, const std::string& status) {
  if (path.starts_with("/api/v1/calibrate") && status != "404") return true;  // of `flogmap calibrate` alone
  return status == "101" || status == "503" || status == "429" || status == "default" ||
         (status == "204" && path.ends_with("/image.png")) || (status == "409" && method == "PATCH") ||
         (status == "409" && (path.ends_with(":reset") || path.ends_with(":level")));
}

/// "GET /path 200" of what the document declares and nobody got.
std::vector<std::string> unreached(const YAML::Node& document, const Answers& reached) {
  std::vector<std::string> missing;
  for (const auto& described_path : document["paths"]) {
    const auto path = described_path.first.as<std::string>();
    for (const auto& described : described_path.second) {
      const std::string method = upper(described.first.as<std::string>());
      for (const auto& response : described.second["responses"]) {
        const auto status = response.first.as<std::string>();
        if (out_of_reach(method, path, status) || reached.contains({method, path, status})) continue;
        missing.push_back(method + " " + path + " " + status);
      }
    }
  }
  return missing;
}

TEST_F(Contract, EveryDeclaredAnswerIsGivenAsDeclared) {
  const std::string tile = a_tile();
  const json views = json::parse(ask("GET", "/api/v1/maps/live/views").body);
  std::vector<Case> cases = map_cases(tile, views["views"][0]["number"].dump());
  for (const char* format : {"ros", "png", "ply", "pcd", "bt", "tum", "kitti"}) {
    cases.push_back({"GET", kMap + "/export", std::string("/api/v1/maps/live/export?format=") + format});
  }
  for (const auto& more : {posted_cases(tile, a_free_place()), session_cases()})
    cases.insert(cases.end(), more.begin(), more.end());
  Answers reached;
  const auto ask_case = [](const Case& c) { return ask(c.method, c.target, c.headers, c.body); };
  for (const Case& c : cases) {
    const YAML::Node described = operation(c);
    const HttpReply reply = ask_case(c);
    check_reply(document_, described, c, reply);
    reached.insert({c.method, c.path, std::to_string(c.status)});
    if (c.method != "GET" || c.status != 200) continue;
    check_head(c, reply, ask_case);
    if (!described["responses"]["304"]) continue;
    ASSERT_TRUE(reply.headers.contains("etag")) << c.target;
    check_again(c, reply, ask_case);
    reached.insert({"GET", c.path, "304"});
  }
  EXPECT_THAT(unreached(document_, reached), IsEmpty());
}

/// "/api/v1/maps/{id}/cell" → "/api/v1/maps/0/cell"
std::string some_target(const std::string& path) {
  std::string target;
  bool named = false;
  for (const char c : path) {
    if (c == '{') target += '0';
    named = c == '{' || (named && c != '}');
    if (!named && c != '}') target += c;
  }
  return target;
}

TEST_F(Contract, EveryPathSaysWhichMethodsItTakesAndRefusesTheOthers) {
  for (const auto& path : document_["paths"]) {
    const std::string target = some_target(path.first.as<std::string>());
    for (const char* method : {"DELETE", "PUT", "OPTIONS", "TRACE"}) {
      const HttpReply reply = ask(method, target);
      EXPECT_EQ(reply.status, std::string(method) == "OPTIONS" ? 204 : 405) << method << " " << target;
      ASSERT_TRUE(reply.headers.contains("allow")) << method << " " << target;
      const std::string allow = ", " + reply.headers.at("allow") + ",";
      for (const std::string known : {"get", "post", "patch"}) {
        EXPECT_EQ(allow.find(std::string(", ").append(upper(known)).append(",")) != std::string::npos,
                  path.second[known].IsDefined())
            << target << " allows " << allow;
      }
    }
  }
}

TEST_F(Contract, TokensAndRolesAreAskedForWhereTheDocumentSays) {
  constexpr int kMostGuesses = 5;  // after ten of them nobody is heard for a minute
  int guesses = 0;
  for (const auto& path : document_["paths"]) {
    const std::string target = some_target(path.first.as<std::string>());
    for (const auto& described : path.second) {
      const std::string method = upper(described.first.as<std::string>());
      if (target.find("/log") != std::string::npos) continue;  // they give and take roles
      const bool open = described.second["security"].IsDefined();
      const bool control = described.second["x-role"].IsDefined();
      const int stranger = ask(method, target, {}, "", "").status;
      EXPECT_EQ(stranger == 401, !open) << method << " " << target << " " << stranger;
      if (!open && guesses++ < kMostGuesses) {
        EXPECT_EQ(ask(method, target, {}, "", "Bearer wrong-secret").status, 401) << target;
      }
      const int viewer = ask(method, target, {}, "", kView).status;
      EXPECT_EQ(viewer == 403, control) << method << " " << target << " " << viewer;
    }
  }
}

TEST_F(Contract, TheLogIsOneJsonObjectALine) {
  ASSERT_TRUE(program_->wait_for_log("a map begins", std::chrono::seconds(10)));
  for (const std::string& line : program_->log()) {
    const json event = json::parse(line, nullptr, false);
    ASSERT_TRUE(event.is_object()) << line;
    for (const char* field : {"time", "level", "message"}) EXPECT_TRUE(event.contains(field)) << line;
  }
}

// The last one: from then on nobody is heard here for a minute.
TEST_F(Contract, TenWrongTokensAreEnoughForAMinute) {
  int status = 0;
  for (int i = 0; i < 12 && status != 429; ++i) {
    const HttpReply reply =
        ask("POST", "/api/v1/login", {{"Content-Type", kJson}}, R"({"token":"wrong-secret"})");
    status = reply.status;
    if (status == 429) {
      EXPECT_EQ(reply.headers.at("retry-after"), "60");
    }
  }
  EXPECT_EQ(status, 429);
}

TEST(Program, EndsWithinTenSecondsAndSaysGoodbye) {
  const testing::TemporaryFolder folder;
  RunningProgram program({"--source", "sim:" + folder.write("scene.json", testing::kSmallScene).string(),
                          "--store", (folder.path() / "map.flog").string()});
  const auto ready = [&] { return http(program.port(), "GET", "/readyz").status == 200; };
  for (int i = 0; i < 600 && !ready(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  StreamClient reads(program.port()), stalls(program.port());
  reads.send(hello_frame());
  stalls.send(hello_frame());
  const auto asked = std::chrono::steady_clock::now();
  ::kill(program.pid(), SIGTERM);
  EXPECT_EQ(reads.wait_for_close(), 1001);
  EXPECT_EQ(program.end(0), 0);  // only waits
  EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(10));
  const std::vector<std::string> log = program.log();
  EXPECT_TRUE(std::any_of(log.begin(), log.end(), [](const std::string& line) {
    return line.find("\"shutting down\"") != std::string::npos;
  }));
}

}  // namespace
}  // namespace flogmap
