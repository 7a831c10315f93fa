// The running program and a disk that takes nothing: full or read-only, from the start or from some moment
// on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <memory>

#include "tests/server/file_limit.hpp"
#include "tests/server/mapping_program.hpp"

namespace flogmap {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// What the program may write into a file; 0: nothing, as on a disk that has become read-only.
void limit_files_of(const RunningProgram& program, rlim_t bytes) {
  const rlimit limit{bytes, RLIM_INFINITY};
  ASSERT_EQ(::prlimit(program.pid(), RLIMIT_FSIZE, &limit, nullptr), 0);
}

std::unique_ptr<RunningProgram> started_within(rlim_t bytes, const std::vector<std::string>& arguments) {
  const FileLimit limit(bytes);
  return std::make_unique<RunningProgram>(arguments);
}

/// Refused by the disk it says so in words and maps on; as soon as the disk relents nothing is said any more,
/// and at the end everything is stored.
void expect_mapping_goes_on(RunningProgram& program, const std::filesystem::path& store,
                            const std::function<void()>& relent) {
  ASSERT_TRUE(wait_until([&] { return is_ready(program) && !warning_of(program, store).empty(); }));
  EXPECT_THAT(warning_of(program, store), HasSubstr("mapping goes on"));
  const std::uint64_t then = revision_of(program);
  EXPECT_TRUE(wait_until([&] { return revision_of(program) > then; }));
  EXPECT_TRUE(holds_a_map(store));
  relent();
  EXPECT_TRUE(wait_until([&] { return warning_of(program, store).empty(); }));
  EXPECT_TRUE(program.wait_for_log("no longer so", std::chrono::seconds(5)));
  const std::uint64_t last = revision_of(program);
  EXPECT_EQ(program.end(SIGTERM), 0);
  EXPECT_GE(load_map(store).revision, last);
}

/// A store that its program closed itself.
StoredMap leave_a_store(const std::filesystem::path& store, const std::filesystem::path& folder) {
  RunningProgram program(mapping_into(store, folder));
  EXPECT_TRUE(wait_until([&] { return revision_of(program) > 3; }));
  EXPECT_EQ(program.end(SIGTERM), 0);
  return load_map(store);
}

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

/// Fills up, or becomes read-only, while the program maps.
class DiskWhileMapping : public ::testing::TestWithParam<rlim_t> {};

TEST_P(DiskWhileMapping, ThatTakesNoMoreIsSaidInWordsAndMappingGoesOn) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  const auto program = started_within(RLIM_INFINITY, mapping_into(store, folder.path()));
  ASSERT_TRUE(wait_until([&] { return holds_a_map(store); }));
  limit_files_of(*program, GetParam());
  expect_mapping_goes_on(*program, store, [&] { limit_files_of(*program, RLIM_INFINITY); });
}

INSTANTIATE_TEST_SUITE_P(FullOrReadOnly, DiskWhileMapping, ::testing::Values(20'000, 0));

TEST(DiskAtTheStart, ThatIsFullRightAfterAKillKeepsNobodyFromMapping) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  leave_a_journal(store, folder.path(), 200'000);
  // Of the journal's index alone there is enough.
  const auto program = started_within(40'000, mapping_into(store, folder.path()));
  expect_mapping_goes_on(*program, store, [&] { limit_files_of(*program, RLIM_INFINITY); });
}

TEST(DiskAtTheStart, ThatIsFullLetsTheStoredMapBeGoneOnWith) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  const StoredMap before = leave_a_store(store, folder.path());
  const auto program = started_within(0, mapping_into(store, folder.path()));
  ASSERT_TRUE(wait_until([&] { return is_ready(*program); }));
  EXPECT_EQ(session_of(*program)["epoch"], before.epoch);
  expect_mapping_goes_on(*program, store, [&] { limit_files_of(*program, RLIM_INFINITY); });
  EXPECT_GE(load_map(store).trajectory.size(), before.trajectory.size());
}

/// What was mapped then is in no store, but pages have seen it: they must not take it for what comes next.
TEST(DiskAtTheStart, ThatIsFullUntilAKillLeavesNoRevisionThatComesAgain) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto store = folder / "map.flog";
  const StoredMap before = leave_a_store(store, folder.path());
  std::uint64_t seen = 0;
  {
    const auto program = started_within(0, mapping_into(store, folder.path()));
    ASSERT_TRUE(wait_until([&] { return is_ready(*program) && revision_of(*program) > before.revision; }));
    seen = revision_of(*program);
    program->end(SIGKILL);
  }
  EXPECT_EQ(testing::difference(load_map(store), before), "");
  const RunningProgram program(mapping_into(store, folder.path()));
  ASSERT_TRUE(wait_until([&] { return is_ready(program); }));
  const HttpReply reply =
      http(program.port(), "GET",
           "/api/v1/maps/live/changes?epoch=" + before.epoch + "&since=" + std::to_string(seen));
  EXPECT_TRUE(revision_of(program) > seen || reply.status == 409) << reply.status;
}

/// Root may write everywhere: what this process starts is to be stopped by permissions like anybody.
bool permissions_count() {
  return ::geteuid() != 0 || ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0) == 0;
}

void make_read_only(const std::filesystem::path& store, bool read_only) {
  using std::filesystem::perms;
  const perms write = perms::owner_write;
  const auto how = read_only ? std::filesystem::perm_options::remove : std::filesystem::perm_options::add;
  std::filesystem::permissions(store, write, how);
  std::filesystem::permissions(store.parent_path(), write, how);
}

TEST(DiskAtTheStart, ThatIsReadOnlyLetsTheStoredMapBeGoneOnWith) {
  const TemporaryFolder folder = TemporaryFolder::in_memory(), scenes;
  const auto store = folder / "map.flog";
  const StoredMap before = leave_a_store(store, scenes.path());
  if (!permissions_count()) GTEST_SKIP() << "permissions do not bind this user here";
  make_read_only(store, true);
  RunningProgram program(mapping_into(store, scenes.path()));
  ASSERT_TRUE(wait_until([&] { return is_ready(program); }));
  EXPECT_EQ(session_of(program)["epoch"], before.epoch);
  expect_mapping_goes_on(program, store, [&] { make_read_only(store, false); });
}

TEST(DiskAtTheStart, ThatHasNoMapAndTakesNoneIsRefused) {
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
