// What `record` writes is what the source was: `map` and `serve` make the same map of either.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "tests/server/mapping_program.hpp"

namespace flogmap {
namespace {

using testing::TemporaryFolder;

void run(const std::string& arguments) {
  ASSERT_EQ(std::system((FLOGMAP_PROGRAM " " + arguments + " >/dev/null 2>&1").c_str()), 0) << arguments;
}

/// The map of a whole recording as `serve` keeps it.
StoredMap served(const std::string& source, const std::filesystem::path& store) {
  RunningProgram program({"--source", source, "--pace", "fast", "--store", store.string()});
  EXPECT_TRUE(wait_until([&] { return session_of(program)["state"] == "finished"; }));
  EXPECT_EQ(program.end(SIGTERM), 0);
  return load_map(store);
}

void expect_same(const StoredMap& a, const StoredMap& b) {
  ASSERT_FALSE(a.tiles.empty());
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (std::size_t i = 0; i < a.tiles.size(); ++i) {
    EXPECT_EQ(a.tiles[i].index, b.tiles[i].index);
    EXPECT_EQ(a.tiles[i].tile->cells, b.tiles[i].tile->cells);
  }
  ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    EXPECT_EQ(a.trajectory[i].timestamp_ns, b.trajectory[i].timestamp_ns);
    EXPECT_TRUE(a.trajectory[i].world_from_camera.matrix() == b.trajectory[i].world_from_camera.matrix());
  }
}

TEST(ProgramRecording, MapAndServeMakeTheSameMapOfARecordingAsOfItsSource) {
  const TemporaryFolder folder = TemporaryFolder::in_memory();
  const auto path = [&](const char* name) { return (folder / name).string(); };
  run("simulate --scene room --frames 24 --out " + path("first"));
  run("record --source euroc:" + path("first") + " --out " + path("second"));
  for (const char* name : {"first", "second"}) {
    run("map --source euroc:" + path(name) + " --out " + path(name) + ".map");
  }
  const StoredMap first = load_map(folder / "first.map" / "map.flog");
  expect_same(first, load_map(folder / "second.map" / "map.flog"));
  expect_same(first, served("euroc:" + path("second"), folder / "served.flog"));
}

}  // namespace
}  // namespace flogmap
