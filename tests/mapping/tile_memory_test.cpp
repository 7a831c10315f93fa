// A map larger than its memory: every byte comes back, and the memory stays within its limit.
#include "mapping/tile_memory.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include "mapping/tile_update.hpp"

namespace flogmap {
namespace {

constexpr std::size_t kTileBytes = 3 * kTileColumns * sizeof(Cell);
constexpr std::size_t kLimit = 32 * kTileBytes;

std::shared_ptr<const Tile> tile_of(std::uint32_t seed) {
  std::mt19937 random(seed);
  auto tile = std::make_shared<Tile>();
  tile->cells.resize(3 * kTileColumns);
  for (Cell& cell : tile->cells) {
    const auto bits = random();
    cell = {static_cast<std::uint16_t>(bits), static_cast<std::uint16_t>(bits >> 16U), 7, 0};
  }
  return tile;
}

/// Bytes of mapped files in memory, as the system counts them.
std::size_t resident_file_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    if (word != "RssFile:") continue;
    std::size_t kilobytes = 0;
    status >> kilobytes;
    return kilobytes * 1024;
  }
  return 0;
}

TEST(TileMemoryBefore, AFolderThatIsNotThereIsNamedAndNothingChanges) {
  try {
    TileMemory::keep_within(kLimit, "/nowhere");
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere"), std::string::npos);
  }
  EXPECT_EQ(tile_of(1)->cells, tile_of(1)->cells);
  EXPECT_EQ(TileMemory::use().allocated_bytes, 0U);
}

class TileMemoryTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { TileMemory::keep_within(kLimit, ::testing::TempDir()); }
};

TEST_F(TileMemoryTest, EveryTileComesBackByteForByte) {
  std::vector<std::shared_ptr<const Tile>> tiles;
  for (std::uint32_t seed = 0; seed < 400; ++seed) tiles.push_back(tile_of(seed));
  EXPECT_EQ(TileMemory::use().allocated_bytes, 400 * kTileBytes);
  EXPECT_EQ(TileMemory::use().paged_out_bytes, 400 * kTileBytes - kLimit);
  for (std::uint32_t seed = 0; seed < 400; ++seed)
    ASSERT_EQ(tiles[seed]->cells, tile_of(seed)->cells) << seed;
}

TEST_F(TileMemoryTest, MemoryStaysWithinItsLimitWhateverIsRead) {
  if (resident_file_bytes() == 0) GTEST_SKIP() << "this system does not say what is in memory";
  const std::size_t before = resident_file_bytes();
  std::vector<std::shared_ptr<const Tile>> tiles;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) tiles.push_back(tile_of(seed));  // 98 MB
  EXPECT_LT(resident_file_bytes(), before + kLimit + kTileBytes);
  std::uint64_t sum = 0;
  for (const auto& tile : tiles) sum += tile->cells[4096].empty;
  EXPECT_GT(sum, 0U);
  TileMemory::trim();
  EXPECT_LT(resident_file_bytes(), before + kLimit + kTileBytes);
}

TEST_F(TileMemoryTest, GivenBackItIsUsedAgain) {
  const TileMemoryUse before = TileMemory::use();
  for (std::uint32_t seed = 0; seed < 500; ++seed) tile_of(seed);
  EXPECT_EQ(TileMemory::use().allocated_bytes, before.allocated_bytes);
  EXPECT_EQ(TileMemory::use().paged_out_bytes, before.paged_out_bytes);
}

TEST_F(TileMemoryTest, ThreadsMayMakeReadAndDropTilesTogether) {
  std::atomic<int> wrong = 0;
  const auto work = [&](std::uint32_t first) {
    std::vector<std::shared_ptr<const Tile>> mine(50);
    for (std::uint32_t i = 0; i < 300; ++i) {
      const std::uint32_t slot = i % 50;
      if (mine[slot] && mine[slot]->cells != tile_of(first + i - 50)->cells) ++wrong;
      mine[slot] = tile_of(first + i);
      if (i % 40 == 0) TileMemory::trim();
    }
  };
  { const std::jthread one(work, 10'000), two(work, 20'000); }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace flogmap
