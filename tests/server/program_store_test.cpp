// The running program and its store: killed at any moment. STORE_KILLS says how often (4 unless set).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <random>

#include "tests/server/mapping_program.hpp"

namespace flogmap {
namespace {

using std::chrono::milliseconds;
using testing::TemporaryFolder;

int num_kills() {
  const char* wanted = std::getenv("STORE_KILLS");
  return wanted != nullptr ? std::atoi(wanted) : 4;
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

TEST(ProgramStore, AMapWhoseTilesAreBehindItsPathIsBuiltAnewAtTheNextStart) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  const std::vector<std::string> arguments = mapping_into(store, folder.path());
  {
    RunningProgram program(arguments);
    ASSERT_TRUE(wait_until([&] { return revision_of(program) > 10; }));
    EXPECT_EQ(program.end(SIGTERM), 0);
  }
  const StoredMap before = load_map(store);
  {
    MapStore file(store);
    file.begin(before);
    file.set_behind(true);  // as a kill leaves it while the map is built anew
    file.commit();
  }
  RunningProgram program(arguments);
  EXPECT_TRUE(program.wait_for_log("is built anew", std::chrono::seconds(5)));
  EXPECT_TRUE(wait_until([&] { return revision_of(program) > before.revision; }));
  EXPECT_EQ(program.end(SIGTERM), 0);
  const StoredMap after = load_map(store);
  EXPECT_FALSE(after.behind);
  EXPECT_EQ(after.epoch, before.epoch);
  EXPECT_GE(after.tiles.size(), before.tiles.size());
}

TEST(ProgramStore, WhoReadsItsLogMayLeave) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  RunningProgram program(mapping_into(folder / "map.flog", folder.path()));
  ASSERT_TRUE(wait_until([&] { return revision_of(program) > 0; }));  // it runs
  program.hang_up();
  for (int i = 0; i < 5; ++i) {  // each is told in the log
    EXPECT_EQ(http(program.port(), "POST", "/api/v1/session:reset").status, 200);
    std::this_thread::sleep_for(milliseconds(200));
  }
  EXPECT_EQ(program.end(SIGTERM), 0);
  EXPECT_TRUE(holds_a_map(folder / "map.flog"));
}

TEST(ProgramStore, RulesOverWhatIsStoredFollowTheOptionsOfEachStart) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  std::vector<std::string> arguments = mapping_into(folder / "map.flog", folder.path());
  const auto live_map = [](const RunningProgram& program) {
    return nlohmann::json::parse(http(program.port(), "GET", "/api/v1/maps/live").body);
  };
  std::uint64_t revision = 0;
  {
    RunningProgram program(arguments);
    ASSERT_TRUE(wait_until([&] { return revision_of(program) > 3; }));
    EXPECT_EQ(live_map(program)["min_rays"], 8);
    EXPECT_EQ(program.end(SIGTERM), 0);
    revision = load_map(folder / "map.flog").revision;
  }
  arguments.insert(arguments.end(), {"--min-rays", "3", "--full-confidence-rays", "50"});
  RunningProgram program(arguments);
  ASSERT_TRUE(wait_until([&] { return revision_of(program) > 0; }));
  EXPECT_GT(revision_of(program), revision);  // pictures that viewers keep were made by the old rules
  EXPECT_EQ(live_map(program)["min_rays"], 3);
  for (const auto& layer : live_map(program)["layers"]) EXPECT_EQ(layer["full_confidence_rays"], 50);
  EXPECT_EQ(program.end(SIGTERM), 0);
}

}  // namespace
}  // namespace flogmap
