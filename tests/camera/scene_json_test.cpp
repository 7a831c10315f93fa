#include "camera/simulation/scene_json.hpp"

#include <gmock/gmock.h>

#include <random>
#include <stdexcept>

#include "camera/simulation/faces.hpp"
#include "camera/simulation/occupancy.hpp"
#include "camera/simulation/walk.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kSmallest = R"({"materials": {"m": {"pattern": "wood"}},
  "solids": [{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}, "material": "m"}],
  "path": {"steps": true, "points": [{"at": [3, 0, 1], "look_at": [0, 0, 1]}]}})";

TEST(BuiltInScenes, AreTheSevenOfTheManualAndCanAllBeWalked) {
  EXPECT_THAT(built_in_scenes(),
              ::testing::UnorderedElementsAre("room", "two-boxes-near", "two-boxes-far", "corridor-loop",
                                              "moving-box", "table", "outdoor-yard"));
  for (const std::string& name : built_in_scenes()) {
    const Scene scene = load_scene(name);
    EXPECT_EQ(scene.name, name);
    EXPECT_GT(Walk(scene.path, scene.rate_hz, 1).round_s(), 5) << name;
  }
}

TEST(BuiltInScenes, TheCameraNeverWalksThroughAnything) {
  for (const std::string& name : built_in_scenes()) {
    Scene scene = load_scene(name);
    const Walk walk(scene.path, scene.rate_hz, 1);
    for (double t = 0; t < walk.round_s(); t += 0.2) {
      const Eigen::Vector3d at = walk.pose(t).translation();
      constexpr double kClearM = 0.15;
      scene.truth.cell_m = 2 * kClearM;
      scene.truth.min_m = at.head<2>() - Eigen::Vector2d::Constant(kClearM);
      scene.truth.max_m = at.head<2>() + Eigen::Vector2d::Constant(kClearM);
      EXPECT_EQ(true_occupancy(scene, at.z() - kClearM, at.z() + kClearM, t).at(0, 0), 0)
          << name << " at " << t << " s";
    }
  }
}

TEST(BuiltInScenes, TheCameraTurnsSlowlyEnoughToBeFollowed) {
  for (const std::string& name : built_in_scenes()) {
    const Scene scene = load_scene(name);
    if (scene.path.steps) continue;
    const Walk walk(scene.path, scene.rate_hz, 1);
    double fastest = 0;
    for (double t = 0; t < walk.round_s(); t += 0.1) {
      const Eigen::AngleAxisd turn(walk.pose(t).linear().transpose() * walk.pose(t + 0.1).linear());
      fastest = std::max(fastest, turn.angle() / 0.1);
    }
    EXPECT_LT(fastest, 1.0) << name;  // rad/s
  }
}

TEST(Scene, MistakesAreNamedWithPlaceAndValue) {
  const auto fails = [](const std::string& what, const std::string& with, const std::string& place,
                        const std::string& why) {
    std::string text = kSmallest;
    text.replace(text.find(what), what.size(), with);
    EXPECT_THAT(
        [&] { static_cast<void>(parse_scene(text, "my.json", ".")); },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("my.json"), HasSubstr(place), HasSubstr(why))))
        << with;
  };
  fails("\"wood\"", "\"wod\"", "materials.m", "wood");
  fails("\"wood\"", "7", "materials.m.pattern", "7");
  fails("\"pattern\"", "\"patern\"", "materials.m.patern", "allowed: ");
  fails("\"material\": \"m\"", "\"material\": \"n\"", "solids[0].material", "\"n\"");
  fails("[1, 1, 1]", "[1, 1]", "solids[0].box.max", "3 numbers");
  fails("[1, 1, 1]", "[1, 1, -1]", "solids[0].box", "size > 0");
  fails("\"box\"", "\"ball\"", "solids[0]", "cylinder");
  fails("\"look_at\": [0, 0, 1]", "\"look_at\": [3, 0, 1]", "path.points[0].look_at", "different");
  fails("\"steps\": true", "\"steps\": 1", "path.steps", "true or false");
  fails("\"solids\"", "\"solid\"", "solids", "at least one");
  fails("{\"materials\"", "[\"materials\"", "JSON", "my.json");
}

TEST(Scene, DamagedTextNeverCrashes) {
  std::mt19937 random(23);
  for (int trial = 0; trial < 500; ++trial) {
    std::string text = kSmallest;
    for (int edit = 0; edit < 3 && !text.empty(); ++edit)
      text[random() % text.size()] = static_cast<char>(random() % 128);
    try {
      static_cast<void>(parse_scene(text, "x", "."));
    } catch (const std::runtime_error& error) {
      EXPECT_STRNE(error.what(), "");
    }
  }
}

TEST(Scene, AMeshIsReadFromItsObjFile) {
  const testing::TemporaryFolder folder;
  folder.write("roof.obj",
               "# a wedge\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 4 3 2 1\nf 1/1 2//2 5\nf 2 3 "
               "-1\nf 3 4 5\nf 4 1 5\n");
  const std::string json =
      R"({"materials": {"m": {}}, "solids": [{"mesh": {"file": "roof.obj", "scale": 2, "at": [1, 0, 0]},
    "material": "m"}], "path": {"steps": true, "points": [{"at": [9, 0, 1], "look_at": [0, 0, 1]}]},
    "truth": {"cell_m": 0.5, "layers_m": [0.1, 0.9], "min": [0, -1], "max": [4, 3]}})";
  const Scene scene = load_scene(folder.write("scene.json", json).string());
  EXPECT_EQ(scene.solids[0].triangles.size(), 6U);
  EXPECT_EQ(faces_of(scene).size(), 6U);
  const Image<std::uint8_t> layer = true_occupancy(scene, 0.1, 0.9, 0);
  EXPECT_EQ(layer.at(4, 4), 255);  // the middle, inside
  EXPECT_EQ(layer.at(0, 4), 0);
  for (const char* broken :
       {"f 1 2 3\n", "v 0 0\n", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n", "v 0 0 0\nf 1 1\n", ""}) {
    folder.write("roof.obj", broken);
    EXPECT_THROW(static_cast<void>(load_scene((folder.path() / "scene.json").string())), std::runtime_error)
        << broken;
  }
}

TEST(Faces, LookOutwardsOnSolidsAndInwardsInHalls) {
  for (const std::string& name : built_in_scenes()) {
    const Scene scene = load_scene(name);
    for (const Face& face : faces_of(scene)) {
      const Solid& solid = scene.solids[face.solid];
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& corner : face.corners_m)
        middle += corner / static_cast<double>(face.corners_m.size());
      const double outwards = face.normal.dot(middle - solid.world_from_solid.translation());
      EXPECT_GT(solid.kind == SolidKind::hall ? -outwards : outwards, 0) << name;
      EXPECT_NEAR(face.u_axis.cross(face.v_axis).dot(face.normal), 1, 1e-9);
    }
  }
}

}  // namespace
}  // namespace flogmap
