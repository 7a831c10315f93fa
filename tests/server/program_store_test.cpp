// The running program and its disk: killed at any moment, with no room, and with room again. STORE_KILLS says
// how often it is killed (4 unless set).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <random>

#include "server/map_store.hpp"
#include "tests/camera/small_scene.hpp"
#include "tests/server/loopback_hub.hpp"
#include "tests/server/map_store_support.hpp"
#include "tests/server/running_program.hpp"

namespace flogmap {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::steady_clock;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr auto kPatience = std::chrono::seconds(60);

int num_kills() {
  const char* wanted = std::getenv("STORE_KILLS");
  return wanted != nullptr ? std::atoi(wanted) : 4;
}

/// A small scene walked through without end, its map kept beside it.
std::vector<std::string> mapping_into(const std::filesystem::path& store,
                                      const std::filesystem::path& folder) {
  std::ofstream(folder / "scene.json") << testing::kSmallScene;
  return {"--source", "sim:" + (folder / "scene.json").string(), "--pace", "fast", "--store", store.string()};
}

/// The store holds a map; what is no map makes load_map() throw.
bool holds_a_map(const std::filesystem::path& store) {
  return testing::error_of([&] { (void)load_map(store); }).empty();
}

json session_of(const RunningProgram& program) {
  return json::parse(http(program.port(), "GET", "/api/v1/session").body);
}

std::uint64_t revision_of(const RunningProgram& program) {
  const json session = session_of(program);
  return session["rev"].is_number() ? session["rev"].get<std::uint64_t>() : 0;
}

/// Until `holds` does; false after a minute.
template <typename Condition>
bool wait_until(const Condition& holds) {
  const auto deadline = steady_clock::now() + kPatience;
  while (!holds()) {
    if (steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(milliseconds(50));
  }
  return true;
}

TEST(ProgramStore, KilledAtAnyMomentItLacksAtMostTheLastSecond) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  std::mt19937 random(8);
  std::uint64_t stored_before = 0;
  int late = 0;
  for (int i = 0; i < num_kills(); ++i) {
    RunningProgram program(mapping_into(store, folder.path()));
    const std::uint64_t at_start = revision_of(program);
    // Mapping goes on for a while; then the clock of the last second starts.
    ASSERT_TRUE(wait_until([&] { return revision_of(program) > at_start; })) << "kill " << i;
    std::this_thread::sleep_for(milliseconds(random() % 700));
    const std::uint64_t a_second_before = revision_of(program);
    std::this_thread::sleep_for(milliseconds(1000 + random() % 50));
    EXPECT_EQ(program.end(SIGKILL), -SIGKILL);
    const StoredMap map = load_map(store);  // checks every byte
    ASSERT_GE(map.revision, stored_before) << "kill " << i;
    ASSERT_FALSE(map.tiles.empty());
    stored_before = map.revision;
    late += map.revision < a_second_before ? 1 : 0;
  }
  // On a machine that does much else besides, writing may now and then take longer than the second leaves.
  std::printf("%d of %d kills came before a second old change was durable\n", late, num_kills());
  EXPECT_LE(late, 1 + num_kills() / 50);
}

void limit_files_of(const RunningProgram& program, rlim_t bytes) {
  const rlimit limit{bytes, RLIM_INFINITY};
  ASSERT_EQ(::prlimit(program.pid(), RLIMIT_FSIZE, &limit, nullptr), 0);
}

bool is_ready(const RunningProgram& program) {
  return json::parse(http(program.port(), "GET", "/readyz").body)["ready"] == true;
}

/// What /readyz says of the store; empty if nothing. Only for a program that is ready.
std::string warning_of(const RunningProgram& program, const std::filesystem::path& store) {
  const json ready = json::parse(http(program.port(), "GET", "/readyz").body);
  EXPECT_EQ(ready["ready"], true);
  for (const std::string warning : ready["warnings"]) {
    if (warning.find(store.string()) != std::string::npos) return warning;
  }
  return {};
}

TEST(ProgramStore, AFullDiskIsSaidInWordsAndMappingGoesOn) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  std::signal(SIGXFSZ, SIG_IGN);  // inherited: writing beyond the limit is an error, as on a full disk
  RunningProgram program(mapping_into(store, folder.path()));
  ASSERT_TRUE(wait_until([&] { return holds_a_map(store); }));
  limit_files_of(program, 20'000);
  ASSERT_TRUE(wait_until([&] { return !warning_of(program, store).empty(); }));
  EXPECT_THAT(warning_of(program, store), HasSubstr("mapping goes on"));
  const std::uint64_t then = revision_of(program);
  EXPECT_TRUE(wait_until([&] { return revision_of(program) > then; }));
  EXPECT_TRUE(holds_a_map(store));
  limit_files_of(program, RLIM_INFINITY);
  EXPECT_TRUE(wait_until([&] { return warning_of(program, store).empty(); }));
  EXPECT_TRUE(program.wait_for_log("no longer so", std::chrono::seconds(5)));
  const std::uint64_t last = revision_of(program);
  EXPECT_EQ(program.end(SIGTERM), 0);
  EXPECT_GE(load_map(store).revision, last);
}

/// What this process and those that it starts may write into a file, until the end of the scope.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
};

/// Maps until the journal holds more than `bytes`, and is killed.
void leave_a_journal(const std::filesystem::path& store, const std::filesystem::path& folder,
                     std::uintmax_t bytes) {
  RunningProgram program(mapping_into(store, folder));
  EXPECT_TRUE(wait_until([&] {
    std::error_code error;
    const auto size = std::filesystem::file_size(store.string() + "-wal", error);
    return !error && size > bytes && revision_of(program) > 0;
  }));
  program.end(SIGKILL);
}

TEST(ProgramStore, ADiskThatIsFullRightAfterAKillKeepsNobodyFromMapping) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  std::signal(SIGXFSZ, SIG_IGN);
  leave_a_journal(store, folder.path(), 200'000);
  const std::vector<std::string> arguments = mapping_into(store, folder.path());
  std::unique_ptr<RunningProgram> program;
  {
    const FileLimit no_room(40'000);  // of the journal's index alone there is enough
    program = std::make_unique<RunningProgram>(arguments);
  }
  ASSERT_TRUE(wait_until([&] { return is_ready(*program); }));
  ASSERT_TRUE(wait_until([&] { return !warning_of(*program, store).empty(); }));
  EXPECT_THAT(warning_of(*program, store), HasSubstr("mapping goes on"));
  const std::uint64_t then = revision_of(*program);
  EXPECT_TRUE(wait_until([&] { return revision_of(*program) > then; }));
  limit_files_of(*program, RLIM_INFINITY);
  EXPECT_TRUE(wait_until([&] { return warning_of(*program, store).empty(); }));
  const std::uint64_t last = revision_of(*program);
  EXPECT_EQ(program->end(SIGTERM), 0);
  EXPECT_GE(load_map(store).revision, last);
}

TEST(ProgramStore, AStoreThatCannotBeWrittenIsRefusedAtTheStart) {
  const TemporaryFolder folder;
  try {
    RunningProgram program(mapping_into("/proc/flogmap/map.flog", folder.path()));
    FAIL() << "it came up";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/proc/flogmap/map.flog"));
  }
}

}  // namespace
}  // namespace flogmap
