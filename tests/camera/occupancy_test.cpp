// True occupancy: a cell is occupied if and only if a solid overlaps its box.
#include "camera/simulation/occupancy.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "camera/simulation/scene_json.hpp"

namespace flogmap {
namespace {

Scene with_solids(const std::string& solids) {
  return parse_scene(R"({"materials": {"m": {}}, "solids": [)" + solids +
                         R"(], "path": {"steps": true, "points": [{"at": [0, 0, 1], "look_at": [1, 0, 1]}]},
                        "truth": {"cell_m": 0.1, "layers_m": [0.1, 0.9], "min": [-1, -1], "max": [1, 1]}})",
                     "test", ".");
}

int occupied(const Image<std::uint8_t>& layer) {
  return static_cast<int>(std::count(layer.pixels.begin(), layer.pixels.end(), 255));
}

TEST(Occupancy, ABoxCoversItsCellsAndNoneItOnlyTouches) {
  const Scene scene =
      with_solids(R"({"box": {"min": [-0.3, 0.2, 0], "max": [0.2, 0.4, 1]}, "material": "m"})");
  const Image<std::uint8_t> layer = true_occupancy(scene, 0.1, 0.9, 0);
  ASSERT_EQ(layer.width, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x)
      EXPECT_EQ(layer.at(x, y) == 255, x >= 7 && x < 12 && y >= 12 && y < 14) << x << ' ' << y;
  }
}

TEST(Occupancy, OnlyWhatReachesIntoTheLayerCounts) {
  const Scene scene =
      with_solids(R"({"box": {"min": [-0.3, 0.2, 0.5], "max": [0.2, 0.4, 0.7]}, "material": "m"})");
  EXPECT_EQ(occupied(true_occupancy(scene, 0.1, 0.5, 0)), 0);
  EXPECT_EQ(occupied(true_occupancy(scene, 0.7, 0.9, 0)), 0);
  EXPECT_EQ(occupied(true_occupancy(scene, 0.1, 0.5001, 0)), 10);
  EXPECT_EQ(occupied(true_occupancy(scene, 0.55, 0.6, 0)), 10);  // wholly inside
}

TEST(Occupancy, APlaneIsWhereItsFrontIsAndAMillimetreBehind) {
  const Scene wall = with_solids(
      R"({"plane": {"at": [0.45, 0.1, 0.5], "size_m": [0.6, 0.4], "facing": [-1, 0, 0]}, "material": "m"})");
  const Image<std::uint8_t> layer = true_occupancy(wall, 0.1, 0.9, 0);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x)
      EXPECT_EQ(layer.at(x, y) == 255, x == 14 && y >= 8 && y < 14) << x << ' ' << y;
  }
  EXPECT_EQ(occupied(true_occupancy(wall, 0.71, 0.9, 0)), 0);  // it ends at 0.7
  const Scene floor = with_solids(
      R"({"plane": {"at": [0.25, 0.35, 0.5], "size_m": [0.3, 0.1], "facing": [0, 0, 1]}, "material": "m"})");
  EXPECT_EQ(occupied(true_occupancy(floor, 0.4999, 0.6, 0)), 3 * 1);
  EXPECT_EQ(occupied(true_occupancy(floor, 0.5, 0.6, 0)), 0);  // nothing above its front
}

TEST(Occupancy, ATurnedBoxIsTheCellsItsOutlineMeets) {
  const Scene scene = with_solids(
      R"({"box": {"at": [0.03, 0.02, 0], "size_m": [0.9, 0.5, 1], "yaw_deg": 30}, "material": "m"})");
  const Image<std::uint8_t> layer = true_occupancy(scene, 0.1, 0.9, 0);
  const Eigen::Rotation2Dd turn(-30 * 3.14159265358979 / 180);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      bool overlaps = false;  // by trying points, which may miss a corner but never invent one
      for (int j = 0; j <= 20; ++j) {
        for (int i = 0; i <= 20; ++i) {
          const Eigen::Vector2d p(-1 + 0.1 * (x + i / 20.0), -1 + 0.1 * (y + j / 20.0));
          const Eigen::Vector2d q = turn * (p - Eigen::Vector2d(0.03, 0.02));
          overlaps |= std::abs(q.x()) < 0.45 && std::abs(q.y()) < 0.25;
        }
      }
      EXPECT_TRUE(!overlaps || layer.at(x, y) == 255) << x << ' ' << y;
      const Eigen::Vector2d middle =
          turn * (Eigen::Vector2d(-0.95 + 0.1 * x, -0.95 + 0.1 * y) - Eigen::Vector2d(0.03, 0.02));
      const bool far_away = std::abs(middle.x()) > 0.45 + 0.071 || std::abs(middle.y()) > 0.25 + 0.071;
      EXPECT_TRUE(!far_away || layer.at(x, y) == 0) << x << ' ' << y;
    }
  }
}

TEST(Occupancy, ACylinderHasTheAreaOfItsCircle) {
  Scene scene = with_solids(
      R"({"cylinder": {"at": [0, 0, 0], "radius_m": 0.7, "height_m": 1, "facets": 128}, "material": "m"})");
  scene.truth.cell_m = 0.01;
  const double area = 1e-4 * occupied(true_occupancy(scene, 0.1, 0.9, 0));
  EXPECT_GT(area, 3.14159 * 0.49);
  EXPECT_LT(area, 3.14159 * 0.72 * 0.72);
}

TEST(Occupancy, AHallHasWallsAroundFreeSpace) {
  const Scene scene =
      with_solids(R"({"hall": {"min": [-0.6, -0.5, 0], "max": [0.6, 0.5, 2]}, "material": "m"})");
  const Image<std::uint8_t> layer = true_occupancy(scene, 0.1, 0.9, 0);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      const bool outside = x < 3 || x > 16 || y < 4 || y > 15;
      const bool inside = x > 3 && x < 16 && y > 4 && y < 15;
      EXPECT_EQ(layer.at(x, y) == 255, !outside && !inside) << x << ' ' << y;
    }
  }
}

TEST(Occupancy, FollowsSolidsThatMoveAndGo) {
  const Scene scene =
      with_solids(R"({"box": {"min": [-0.3, 0.2, 0], "max": [0.2, 0.4, 1]}, "material": "m", "until_s": 5,
    "motion": [{"time_s": 1, "shift": [0, 0, 0]}, {"time_s": 2, "shift": [0.2, -0.1, 0]}]})");
  EXPECT_EQ(true_occupancy(scene, 0.1, 0.9, 0).at(7, 13), 255);
  const Image<std::uint8_t> moved = true_occupancy(scene, 0.1, 0.9, 3);
  EXPECT_EQ(moved.at(7, 13), 0);
  EXPECT_EQ(moved.at(9, 11), 255);
  EXPECT_EQ(occupied(true_occupancy(scene, 0.1, 0.9, 5)), 0);
}

TEST(SeenCells, AreThoseBetweenTheCameraAndWhatItSees) {
  const Scene scene = with_solids(R"({"hall": {"min": [-9, -9, -9], "max": [9, 9, 9]}, "material": "m"})");
  SeenCells seen(scene.truth);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // looks along +x
  pose.translation() = Eigen::Vector3d(-0.95, 0.05, 0.5);
  const StereoCamera camera{100, 15.5, 11.5, 0.1, 32, 24};
  seen.add(Image<float>(32, 24, 1 / 1.2F), camera, pose);  // a wall 1.2 m ahead
  const Image<std::uint8_t>& layer = seen.layers()[0];
  for (int x = 0; x <= 12; ++x) EXPECT_EQ(layer.at(x, 10), 255) << x;
  for (int x = 13; x < 20; ++x) EXPECT_EQ(layer.at(x, 10), 0) << x;
  EXPECT_EQ(layer.at(3, 2), 0);                             // out of view
  const Image<std::uint8_t>& surface = seen.surfaces()[0];  // where rays ended
  for (int x = 0; x < 20; ++x) EXPECT_EQ(surface.at(x, 10), x == 12 ? 255 : 0) << x;
}

}  // namespace
}  // namespace flogmap
