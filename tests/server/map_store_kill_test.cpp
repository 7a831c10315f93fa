// Killed at any moment, the store holds a moment of the map, and nothing that was called durable is missing.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <map>
#include <random>
#include <thread>

#include "server/store/store_writer.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

constexpr int kKills = 200;
constexpr int kTilesPerSide = 4;
constexpr std::uint32_t kSeed = 17;

TileIndex tile_of_step(std::uint64_t step) {
  std::mt19937 random(static_cast<std::uint32_t>(step) + kSeed);
  return {static_cast<int>(random() % kTilesPerSide) - 2, static_cast<int>(random() % kTilesPerSide) - 2};
}

TileUpdate update_of_step(std::uint64_t step) {
  return random_tile(tile_of_step(step), step, 1, static_cast<std::uint32_t>(step));
}

TrajectoryEntry pose_of_step(std::uint64_t step) {
  return random_pose(static_cast<std::int64_t>(step), static_cast<std::uint32_t>(step));
}

/// The map after this many steps, each of which adds a pose and changes a tile.
class Walk {
 public:
  StoredMap at(std::uint64_t step) {
    for (; step_ < step; ++step_) last_change_[tile_of_step(step_ + 1)] = step_ + 1;
    StoredMap map = empty_map(kSeed, 1);
    map.revision = step;
    for (const auto& [index, changed] : last_change_) map.tiles.push_back(update_of_step(changed));
    for (std::uint64_t i = 1; i <= step; ++i) map.trajectory.push_back(pose_of_step(i));
    return map;
  }

 private:
  std::uint64_t step_ = 0;
  std::map<TileIndex, std::uint64_t> last_change_;
};

/// Goes on with the walk of the store until killed; tells through the pipe which revision is durable.
[[noreturn]] void write_until_killed(const std::filesystem::path& path, int pipe) {
  MapStore store(path);
  const StoredMap map = store.load().value_or(empty_map(kSeed, 1));
  std::uint64_t step = map.revision;
  MapBegin begin;
  begin.epoch = map.epoch;
  begin.info = map.info;
  begin.camera = map.camera;
  begin.revision = step;
  begin.tiles = map.tiles;
  begin.trajectory = {map.trajectory.begin(), map.trajectory.begin() + static_cast<std::ptrdiff_t>(step)};
  StoreWriter writer(std::move(store), map.options_json, map.calibration_json, std::chrono::milliseconds(2));
  writer.begin(std::move(begin));
  for (std::uint64_t told = 0;;) {
    ++step;
    writer.append_trajectory({pose_of_step(step)});
    writer.publish({update_of_step(step)});
    const std::uint64_t durable = writer.state().committed_revision;
    if (durable != told && ::write(pipe, &durable, sizeof durable) != sizeof durable) ::_exit(1);
    told = durable;
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  }
}

/// When to kill: after the writer has said so often that something is durable, and then a little later.
struct Moment {
  int messages = 0;
  std::chrono::microseconds later{0};
};

Moment random_moment(std::mt19937& random) {
  const bool while_it_opens = random() % 8 == 0;
  if (while_it_opens) return {0, std::chrono::microseconds(random() % 20'000)};
  return {1 + static_cast<int>(random() % 4), std::chrono::microseconds(random() % 4'000)};
}

/// Starts a writer, kills it, and returns the last revision that it called durable.
std::uint64_t durable_when_killed(const std::filesystem::path& path, const Moment& moment) {
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(pipe[0]);
    write_until_killed(path, pipe[1]);
  }
  ::close(pipe[1]);
  std::uint64_t durable = 0, told = 0;
  const auto hear = [&] { return ::read(pipe[0], &told, sizeof told) == sizeof told; };
  for (int i = 0; i < moment.messages && hear(); ++i) durable = told;
  std::this_thread::sleep_for(moment.later);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself";
  while (hear()) durable = told;
  ::close(pipe[0]);
  return durable;
}

/// A pose may be durable before the tile of its step, for they are told one after the other.
void drop_early_pose(StoredMap& map) {
  if (map.trajectory.size() == map.revision + 1) map.trajectory.pop_back();
}

TEST(MapStoreKill, TwoHundredKillsInARowLoseNothingThatWasDurable) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto path = folder / "map.flog";
  { MapStore created(path); }
  Walk walk;
  std::mt19937 random(kSeed);
  std::uint64_t before = 0;
  int with_progress = 0;
  for (int i = 0; i < kKills; ++i) {
    const std::uint64_t durable = durable_when_killed(path, random_moment(random));
    if (before == 0 && durable == 0) continue;  // killed before the map began
    StoredMap map = load_map(path);
    ASSERT_GE(map.revision, std::max(durable, before)) << "kill " << i;
    drop_early_pose(map);
    ASSERT_EQ(difference(map, walk.at(map.revision)), "") << "kill " << i;
    with_progress += map.revision > before ? 1 : 0;
    before = map.revision;
  }
  EXPECT_GT(with_progress, kKills / 4);  // else nothing was tried
}

}  // namespace
}  // namespace flogmap::testing
