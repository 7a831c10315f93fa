// The folder of `flogmap map`, and its figure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <set>

#include "server/export/map_files.hpp"
#include "server/export/path_picture.hpp"
#include "tests/server/map_store_support.hpp"

namespace flogmap::testing {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), folder).string());
  }
  return names;
}

TEST(MapFolder, HoldsWhatIsPromised) {
  const TemporaryFolder folder;
  const StoredMap map = random_map(1, {.num_layers = 2, .tiles_per_side = 1});
  write_map_folder(folder / "out", map);
  const std::set<std::string> promised{"map.flog",         "trajectory.tum",  "fused.png",
                                       "path.png",         "layer_0.png",     "layer_1.png",
                                       "ros/map.pgm",      "ros/map.yaml",    "ros/layer_0.pgm",
                                       "ros/layer_0.yaml", "ros/layer_1.pgm", "ros/layer_1.yaml"};
  EXPECT_EQ(names_in(folder / "out"), promised);
  EXPECT_EQ(difference(load_map(folder / "out/map.flog"), map), "");
}

TEST(MapFolder, CanBeWrittenTwiceAndOfAnEmptyMap) {
  const TemporaryFolder folder;
  write_map_folder(folder / "out", empty_map(1, 1));
  EXPECT_NO_THROW(write_map_folder(folder / "out", empty_map(1, 1)));
}

TEST(MapFolder, OfAnOlderMapWithMoreLayersNoneIsLeftAndNothingElseIsTouched) {
  const TemporaryFolder folder;
  write_map_folder(folder / "out", random_map(1, {.num_layers = 3, .tiles_per_side = 1}));
  const std::set<std::string> own{"layer_2_mine.png", "layer_02.png", "layer_x.png", "layer_7.txt", "layer_"};
  for (const std::string& name : own) write_bytes(folder / "out" / name, {1});
  write_map_folder(folder / "out", random_map(2, {.num_layers = 1, .tiles_per_side = 1}));
  const std::set<std::string> there = names_in(folder / "out");
  for (const char* stale : {"layer_1.png", "layer_2.png", "ros/layer_1.pgm", "ros/layer_2.yaml"})
    EXPECT_FALSE(there.contains(stale)) << stale;
  for (const std::string& name : own) EXPECT_TRUE(there.contains(name)) << name;
  EXPECT_TRUE(there.contains("layer_0.png"));
  EXPECT_TRUE(there.contains("ros/layer_0.yaml"));
}

TEST(MapFolder, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  write_bytes(folder / "out", {1});
  EXPECT_THAT(error_of([&] { write_map_folder(folder / "out", empty_map(1, 1)); }),
              ::testing::HasSubstr((folder / "out").string()));
}

TEST(MapFolder, FusedPictureIsTheDarkestOfItsLayers) {
  const TemporaryFolder folder;
  write_map_folder(folder.path(), random_map(2, {.num_layers = 2, .tiles_per_side = 2}));
  const auto read = [&](const char* name) {
    return cv::imread((folder / name).string(), cv::IMREAD_UNCHANGED);
  };
  const cv::Mat fused = read("fused.png"), low = read("layer_0.png"), high = read("layer_1.png");
  ASSERT_EQ(fused.type(), CV_8UC1);
  cv::Mat darkest;
  cv::min(low, high, darkest);
  EXPECT_EQ(cv::norm(fused, darkest, cv::NORM_INF), 0);
}

/// 64 x 64 columns of 2 cm: free on the left, never seen on the right, a wall along the top (highest y), and
/// a path that goes through the free part from left to right at y = 0.33 m.
StoredMap walked_room() {
  StoredMap map = empty_map(3, 1);
  auto tile = std::make_shared<Tile>();
  tile->cells.resize(kTileColumns);
  for (int y = 0; y < kTileSide; ++y) {
    for (int x = 0; x < kTileSide; ++x) {
      Cell& cell = tile->cells[static_cast<std::size_t>(y * kTileSide + x)];
      if (x < kTileSide / 2) cell = {65535, 0, 5000, 0};
      if (y >= kTileSide - 4) cell = {0, 65535, 5000, 0};
    }
  }
  map.tiles = {{{0, 0}, 1, tile}};
  for (int i = 0; i <= 10; ++i) {
    TrajectoryEntry entry;
    entry.timestamp_ns = i;
    entry.world_from_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // looking along x
    entry.world_from_camera.translation() = Eigen::Vector3d(0.1 + 0.04 * i, 0.33, 1);
    map.trajectory.push_back(entry);
  }
  return map;
}

/// The pixel at a place in metres; the picture begins 0.26 m (13 cells) left of and above the tile.
Rgb pixel_at(const Image<Rgb>& picture, double x_m, double y_m) {
  constexpr double kMargin = 0.26, kTile = 1.28;
  const double px_per_m = 1400 / 90 / 0.02;  // 90 columns fill the sheet by a whole factor
  return picture.at(static_cast<int>((x_m + kMargin) * px_per_m),
                    static_cast<int>((kTile + kMargin - y_m) * px_per_m));
}

TEST(PathPicture, TellsFreeFromNeverSeenFromOccupied) {
  const Image<Rgb> picture = path_picture(walked_room(), Operators::algebraic);
  EXPECT_EQ(pixel_at(picture, 0.31, 0.81), (Rgb{255, 255, 255}));
  EXPECT_EQ(pixel_at(picture, 0.31, 1.25), (Rgb{0, 0, 0}));  // north is up
  const Rgb paper = pixel_at(picture, 1.01, 0.81);
  EXPECT_LT(paper[0], 230);
  EXPECT_GT(paper[0], 180);
  EXPECT_GT(paper[2], paper[0]);  // bluish, unlike any shade of M
}

TEST(PathPicture, ShowsAWallThatOneViewToldOfAndHardlyWhatAFewRaysDid) {
  StoredMap map = walked_room();
  auto tile = std::make_shared<Tile>(*map.tiles[0].tile);
  tile->cells[40 * kTileSide + 15] = {0, 65535, 50, 0};  // K = .06
  tile->cells[40 * kTileSide + 20] = {0, 65535, 4, 0};
  map.tiles[0].tile = tile;
  const Image<Rgb> picture = path_picture(map, Operators::algebraic);
  EXPECT_LT(pixel_at(picture, 0.31, 0.81)[0], 150);
  EXPECT_GT(pixel_at(picture, 0.41, 0.81)[1], 190);
}

TEST(PathPicture, RunsFromAGreenDotToARedSquare) {
  const Image<Rgb> picture = path_picture(walked_room(), Operators::algebraic);
  const Rgb start = pixel_at(picture, 0.1, 0.33), end = pixel_at(picture, 0.5, 0.33);
  EXPECT_GT(start[1], start[0] + 60);
  EXPECT_GT(end[0], end[1] + 60);
  const Rgb middle = pixel_at(picture, 0.3, 0.33);
  EXPECT_GT(middle[2], middle[0] + 60);
}

TEST(PathPicture, BreaksWhereTheCameraWasLost) {
  StoredMap map = walked_room();
  for (std::size_t i = 3; i <= 7; ++i) map.trajectory[i].state = TrackingState::lost;
  EXPECT_EQ(pixel_at(path_picture(map, Operators::algebraic), 0.3, 0.33), (Rgb{255, 255, 255}));
}

TEST(PathPicture, OfASmallMapIsEnlargedSoThatItCanBeRead) {
  const Image<Rgb> picture = path_picture(walked_room(), Operators::algebraic);
  EXPECT_GE(picture.width, 1000);
  EXPECT_GE(picture.height, 1000);
}

TEST(PathPicture, APoseFarAwayDoesNotBlowItUp) {
  StoredMap map = walked_room();
  map.trajectory[5].world_from_camera.translation().x() = 1e18;
  EXPECT_LT(path_picture(map, Operators::algebraic).width, 3000);
}

}  // namespace
}  // namespace flogmap::testing
