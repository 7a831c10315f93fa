// Points, cubes and poses, read back by a reader that knows only the format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cstring>
#include <map>
#include <sstream>
#include <tuple>

#include "mapping/flog/map_value.hpp"
#include "server/export/map_export.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

using Row = std::map<std::string, double>;

/// A number of this type at the start of `bytes`, as a little-endian machine has it.
double number_at(const std::string& type, const char* bytes) {
  const auto as = [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  if (type == "float") return as(float{});
  if (type == "ushort") return as(std::uint16_t{});
  if (type == "uint") return as(std::uint32_t{});
  return as(std::uint8_t{});
}

std::size_t size_of(const std::string& type) { return type == "uchar" ? 1 : type == "ushort" ? 2 : 4; }

using Columns = std::vector<std::pair<std::string, std::string>>;  // type, name

std::vector<Row> rows_of(const std::string& bytes, std::size_t at, std::size_t num_rows,
                         const Columns& columns) {
  std::vector<Row> rows(num_rows);
  for (Row& row : rows) {
    for (const auto& [type, name] : columns) {
      row[name] = number_at(type, bytes.data() + at);
      at += size_of(type);
    }
  }
  EXPECT_EQ(at, bytes.size());
  return rows;
}

std::vector<Row> read_ply(const std::string& bytes) {
  std::istringstream header(bytes);
  std::string line;
  std::size_t num_rows = 0;
  Columns columns;
  while (std::getline(header, line) && line != "end_header") {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "format") {
      EXPECT_EQ(second, "binary_little_endian");
    }
    if (first == "element") num_rows = std::stoul(third);
    if (first == "property") columns.emplace_back(second, third);
  }
  return rows_of(bytes, static_cast<std::size_t>(header.tellg()), num_rows, columns);
}

std::vector<Row> read_pcd(const std::string& bytes) {
  std::istringstream header(bytes);
  std::map<std::string, std::vector<std::string>> fields;
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    for (std::string word; words >> word;) fields[key].push_back(word);
    if (key == "DATA") break;
  }
  EXPECT_EQ(fields["DATA"], std::vector<std::string>{"binary"});
  EXPECT_EQ(fields["WIDTH"], fields["POINTS"]);
  Columns columns;
  for (std::size_t i = 0; i < fields["FIELDS"].size(); ++i) {
    EXPECT_EQ(fields["SIZE"][i], "4");
    columns.emplace_back(fields["TYPE"][i] == "F" ? "float" : "uint", fields["FIELDS"][i]);
  }
  return rows_of(bytes, static_cast<std::size_t>(header.tellg()), std::stoul(fields["POINTS"].at(0)),
                 columns);
}

/// Every seen cell as (x, y, layer) and what it holds.
std::map<std::tuple<int, int, int>, Cell> seen_cells(const StoredMap& map) {
  std::map<std::tuple<int, int, int>, Cell> cells;
  for (const TileUpdate& update : map.tiles) {
    for (std::size_t i = 0; i < update.tile->cells.size(); ++i) {
      const Cell& cell = update.tile->cells[i];
      const int column = static_cast<int>(i % 4096), layer = static_cast<int>(i / 4096);
      if (cell.rays > 0) {
        cells[{update.index.x * 64 + column % 64, update.index.y * 64 + column / 64, layer}] = cell;
      }
    }
  }
  return cells;
}

void expect_cells(const std::vector<Row>& rows, const StoredMap& map) {
  auto cells = seen_cells(map);
  EXPECT_EQ(rows.size(), cells.size());
  for (const Row& row : rows) {
    const int x = static_cast<int>(std::floor(row.at("x") / 0.02));
    const int y = static_cast<int>(std::floor(row.at("y") / 0.02));
    const int layer = static_cast<int>(std::floor((row.at("z") - 0.05) / 0.7));
    const auto it = cells.find({x, y, layer});
    ASSERT_NE(it, cells.end()) << x << "," << y << "," << layer;
    EXPECT_NEAR(row.at("empty"), it->second.empty / 65535.0, 1e-6);
    EXPECT_NEAR(row.at("occupied"), it->second.occupied / 65535.0, 1e-6);
    EXPECT_NEAR(row.at("confidence"), std::min(1.0, it->second.rays / 823.5), 1e-6);
    if (row.contains("rays")) {
      EXPECT_EQ(row.at("rays"), it->second.rays);
    }
    if (row.contains("layer")) {
      EXPECT_EQ(row.at("layer"), layer);
    }
    cells.erase(it);
  }
}

TEST(ExportedCloud, PlyHoldsEverySeenCellOnceWithItsEvidence) {
  const StoredMap map = random_map(2);
  expect_cells(read_ply(export_bytes(ExportFormat::ply, map).bytes), map);
}

TEST(ExportedCloud, PcdHoldsEverySeenCellOnceWithItsEvidence) {
  const StoredMap map = random_map(3);
  expect_cells(read_pcd(export_bytes(ExportFormat::pcd, map).bytes), map);
}

TEST(ExportedCloud, OccupiedIsRedEmptyIsGreenUnsureIsGrey) {
  StoredMap map = empty_map(4, 1);
  auto tile = std::make_shared<Tile>();
  tile->cells.resize(kTileColumns);
  tile->cells[0] = {0, 65535, 60000, 0};
  tile->cells[1] = {65535, 0, 60000, 0};
  tile->cells[2] = {0, 65535, 1, 0};
  map.tiles = {{{0, 0}, 1, tile}};
  const auto rows = read_ply(export_bytes(ExportFormat::ply, map).bytes);
  EXPECT_EQ(rows[0].at("red"), 255);
  EXPECT_EQ(rows[0].at("green"), 0);
  EXPECT_EQ(rows[1].at("green"), 255);
  EXPECT_NEAR(rows[2].at("red"), 128, 1);
  const auto packed =
      static_cast<std::uint32_t>(read_pcd(export_bytes(ExportFormat::pcd, map).bytes)[0].at("rgb"));
  EXPECT_EQ(packed, 0xff0000U);
}

TEST(ExportedCloud, AnEmptyMapIsACloudWithoutPoints) {
  EXPECT_TRUE(read_ply(export_bytes(ExportFormat::ply, empty_map(1, 1)).bytes).empty());
  EXPECT_TRUE(read_pcd(export_bytes(ExportFormat::pcd, empty_map(1, 1)).bytes).empty());
}

octomap::OcTree read_bt(const std::filesystem::path& path) {
  octomap::OcTree tree(1);
  EXPECT_TRUE(tree.readBinary(path.string()));
  return tree;
}

TEST(ExportedOctomap, KnowsEveryCellFromTheFloorOfItsLayerToItsTop) {
  const TemporaryFolder folder;
  const StoredMap map = random_map(5, {.num_layers = 2, .tiles_per_side = 2});
  export_map(ExportFormat::bt, map, folder / "map.bt");
  const octomap::OcTree tree = read_bt(folder / "map.bt");
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.02);
  for (const auto& [key, cell] : seen_cells(map)) {
    const auto [x, y, layer] = key;
    const CellClass expected = classify(Operators::algebraic, cell, map.info.min_rays);
    for (const double z : {0.05 + 0.7 * layer + 0.011, 0.4 + 0.7 * layer, 0.75 + 0.7 * layer - 0.011}) {
      const auto* node = tree.search((x + 0.5) * 0.02, (y + 0.5) * 0.02, z);
      ASSERT_EQ(node != nullptr, expected != CellClass::unknown) << x << "," << y << "," << z;
      if (node != nullptr) {
        EXPECT_EQ(tree.isNodeOccupied(node), expected == CellClass::occupied);
      }
    }
  }
}

TEST(ExportedOctomap, EndsAtTheLayersAndKnowsNothingBeyond) {
  const TemporaryFolder folder;
  StoredMap map = empty_map(6, 1);
  auto tile = std::make_shared<Tile>();
  tile->cells.resize(kTileColumns);
  tile->cells[0] = {0, 65535, 60000, 0};
  map.tiles = {{{0, 0}, 1, tile}};
  export_map(ExportFormat::bt, map, folder / "map.bt");
  const octomap::OcTree tree = read_bt(folder / "map.bt");
  EXPECT_NE(tree.search(0.01, 0.01, 0.4), nullptr);
  EXPECT_EQ(tree.search(0.01, 0.01, 0.03), nullptr);
  EXPECT_EQ(tree.search(0.01, 0.01, 0.77), nullptr);
  EXPECT_EQ(tree.search(0.03, 0.01, 0.4), nullptr);
  EXPECT_EQ(tree.search(-0.01, 0.01, 0.4), nullptr);
}

TEST(ExportedOctomap, AMapTooLargeForItIsRefused) {
  StoredMap map = empty_map(7, 1);
  auto tile = std::make_shared<Tile>();
  tile->cells.assign(kTileColumns, {0, 65535, 60000, 0});
  map.tiles = {{{600, 0}, 1, tile}};
  EXPECT_THAT(error_of([&] { export_bytes(ExportFormat::bt, map); }),
              ::testing::HasSubstr("m from the origin"));
}

StoredMap walked_map() {
  StoredMap map = empty_map(8, 1);
  const std::int64_t start_ns = 1'700'000'000'123'456'789;
  for (std::uint32_t i = 0; i < 12; ++i)
    map.trajectory.push_back(random_pose(start_ns + 50'000'001LL * i, i));
  return map;
}

std::vector<TrajectoryEntry> with_pose(const StoredMap& map) {
  std::vector<TrajectoryEntry> entries;
  for (const auto& entry : map.trajectory) {
    if (entry.state == TrackingState::ok || entry.state == TrackingState::weak) entries.push_back(entry);
  }
  return entries;
}

TEST(ExportedTrajectory, TumHoldsTimeAndPoseOfEveryTrackedFrameAndInventsNone) {
  const StoredMap map = walked_map();
  std::istringstream text(export_bytes(ExportFormat::tum, map).bytes);
  for (const TrajectoryEntry& entry : with_pose(map)) {
    long long seconds = 0, fraction = 0;
    char point = 0;
    Eigen::Vector3d p;
    Eigen::Quaterniond q;
    text >> seconds >> point >> fraction >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
    EXPECT_EQ(seconds * 1'000'000'000 + fraction, entry.timestamp_ns);
    EXPECT_TRUE(p.isApprox(entry.world_from_camera.translation(), 1e-8));
    EXPECT_TRUE(q.toRotationMatrix().isApprox(entry.world_from_camera.linear(), 1e-8));
  }
  std::string more;
  EXPECT_FALSE(text >> more);
}

TEST(ExportedTrajectory, KittiHoldsTheUpperThreeRowsOfEveryPose) {
  const StoredMap map = walked_map();
  std::istringstream text(export_bytes(ExportFormat::kitti, map).bytes);
  for (const TrajectoryEntry& entry : with_pose(map)) {
    std::string line;
    std::getline(text, line);
    std::istringstream numbers(line);
    for (int i = 0; i < 12; ++i) {
      double value = 0;
      numbers >> value;
      EXPECT_NEAR(value, entry.world_from_camera(i / 4, i % 4), 1e-8);
    }
  }
}

TEST(ExportFormats, AreKnownByNameAndOthersAreRefused) {
  EXPECT_EQ(export_format("ros"), ExportFormat::ros);
  EXPECT_EQ(export_format("kitti"), ExportFormat::kitti);
  try {
    export_format("dxf");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "format must be one of ros, png, ply, pcd, bt, tum, kitti, got 'dxf'");
  }
}

}  // namespace
}  // namespace flogmap::testing
