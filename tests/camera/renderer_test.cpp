// Laws of the simulated pictures: what the renderer draws is what rays meet.
#include "camera/simulation/renderer.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "camera/simulation/face_tree.hpp"
#include "camera/simulation/walk.hpp"
#include "tests/camera/small_scene.hpp"

namespace flogmap {
namespace {

using Eigen::Vector3d;

Vector3d ray_of(const StereoCamera& camera, double x, double y) {
  return {(x - camera.cx_px) / camera.focal_px, (y - camera.cy_px) / camera.focal_px, 1};
}

class RendererLaws : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { renderer_ = std::make_unique<Renderer>(testing::small_scene()); }
  static void TearDownTestSuite() { renderer_.reset(); }
  static Eigen::Isometry3d pose(double time_s) {
    return Walk(renderer_->scene().path, renderer_->scene().rate_hz, 3).pose(time_s);
  }
  static inline std::unique_ptr<Renderer> renderer_;
};

TEST_F(RendererLaws, DepthIsThatOfTheNearestFaceAlongTheRay) {
  const FaceTree tree(renderer_->faces());
  const StereoCamera& camera = renderer_->scene().camera;
  std::mt19937 random(5);
  RenderedView view;
  for (const double time_s : {0.0, 3.7, 9.1, 14.2}) {
    const Eigen::Isometry3d world_from_camera = pose(time_s);
    renderer_->render(world_from_camera, 0, view);
    int beside_an_edge = 0;
    for (int i = 0; i < 2000; ++i) {
      const int x = static_cast<int>(random() % camera.width_px),
                y = static_cast<int>(random() % camera.height_px);
      const Vector3d ray = ray_of(camera, x, y);
      const auto hit =
          tree.nearest(world_from_camera.translation(), world_from_camera.linear() * ray.normalized(), 100);
      ASSERT_TRUE(hit);
      const double true_depth = hit->distance_m / ray.norm();
      if (std::abs(1 / view.inverse_depth.at(x, y) - true_depth) > 2e-5 * true_depth) ++beside_an_edge;
    }
    EXPECT_LE(beside_an_edge, 1);  // a ray exactly along an edge may go either way
  }
}

TEST_F(RendererLaws, ABoxOfKnownPlaceHasTheDepthOfItsPlane) {
  Eigen::Isometry3d level = Eigen::Isometry3d::Identity();
  level.translation() = Vector3d(0, -1.5, 1.2);
  level.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // looks along +y, z up
  RenderedView view;
  renderer_->render(level, 0, view);
  const StereoCamera& camera = renderer_->scene().camera;
  EXPECT_NEAR(1 / view.inverse_depth.at(200, 100), 3.5, 1e-5);  // the wall y = 2
  const double below = ray_of(camera, 300, 239).y();
  EXPECT_NEAR(1 / view.inverse_depth.at(300, 239), 1.2 / below, 1e-5);  // the floor z = 0
}

TEST_F(RendererLaws, TheLeftPictureWarpedByTrueDepthIsTheRight) {
  const StereoCamera& camera = renderer_->scene().camera;
  RenderedView left, right;
  double sum = 0;
  int count = 0;
  for (const double time_s : {0.0, 6.0, 12.0}) {
    renderer_->render(pose(time_s), 0, left);
    renderer_->render(pose(time_s) * Eigen::Translation3d(camera.baseline_m, 0, 0), 0, right);
    for (int y = 0; y < camera.height_px; ++y) {
      for (int x = 0; x < camera.width_px; ++x) {
        const double d = camera.focal_px * camera.baseline_m * left.inverse_depth.at(x, y);
        const double xr = x - d;
        const int x0 = static_cast<int>(std::floor(xr));
        if (x0 < 0 || x0 + 1 >= camera.width_px) continue;
        const double there = right.inverse_depth.at(x0, y);
        if (std::abs(there * camera.focal_px * camera.baseline_m - d) > 0.5)
          continue;  // hidden from the right
        const double share = xr - x0;
        sum += std::abs(left.grey.at(x, y) - (1 - share) * right.grey.at(x0, y) -
                        share * right.grey.at(x0 + 1, y));
        ++count;
      }
    }
  }
  EXPECT_GT(count, 150'000);
  EXPECT_LT(sum / count, 3.0);  // greys; what is left is interpolation
}

TEST_F(RendererLaws, TheSamePoseGivesTheSamePicture) {
  RenderedView first, other, again;
  renderer_->render(pose(1), 0, first);
  renderer_->render(pose(8), 0, other);
  renderer_->render(pose(1), 0, again);
  EXPECT_EQ(first.grey, again.grey);
  EXPECT_NE(first.grey, other.grey);
}

/// A bright box before a dark wall, seen head-on by a camera that moves sideways.
Scene edge_scene() {
  return parse_scene(R"({
    "camera": {"width_px": 64, "height_px": 48, "focal_px": 100},
    "texel_m": 0.1,
    "materials": {"dark": {"pattern": "plain", "dark": 0.1, "bright": 0.1},
                  "bright": {"pattern": "plain", "dark": 0.6, "bright": 0.6}},
    "solids": [{"hall": {"min": [-9, -1, -9], "max": [9, 4, 9]}, "material": "dark"},
               {"box": {"min": [0, 1, -5], "max": [5, 1.001, 5]}, "material": "bright"}],
    "light": {"ambient": 1},
    "path": {"steps": true, "points": [{"at": [0, 0, 0], "look_at": [0, 1, 0]}]}
  })",
                     "edge scene", ".");
}

TEST(Outlines, AnEdgeMovesByFractionsOfAPixel) {
  Renderer renderer(edge_scene());
  Eigen::Isometry3d pose = Walk(renderer.scene().path, 1, 1).pose(0);
  RenderedView view;
  for (double shift_px = 0; shift_px < 2; shift_px += 0.05) {
    pose.translation().x() = -shift_px / 100;  // at 1 m a pixel is 1 cm
    renderer.render(pose, 0, view);
    const double dark = view.grey.at(2, 24), bright = view.grey.at(61, 24);
    ASSERT_GT(bright, dark + 60);
    double covered_px = 0;
    for (int x = 1; x < 63; ++x) covered_px += (view.grey.at(x, 24) - dark) / (bright - dark);
    const double edge_px = 62.5 - covered_px;
    EXPECT_NEAR(edge_px, 31.5 + shift_px, 0.15) << shift_px;
  }
}

TEST(FaceTree, AgreesWithTryingEveryFace) {
  const std::vector<Face> faces = faces_of(testing::small_scene());
  const FaceTree tree(faces);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 3000; ++i) {
    const Vector3d from(1.9 * uniform(random), 1.9 * uniform(random), 1.25 + 1.2 * uniform(random));
    const Vector3d direction = Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    double nearest = 1e9;
    for (const Face& face : faces) {
      const auto hit = FaceTree({face}).nearest(from, direction, 1e9);
      if (hit) nearest = std::min(nearest, hit->distance_m);
    }
    const auto hit = tree.nearest(from, direction, 1e9);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance_m, nearest, 1e-9);
    EXPECT_TRUE(tree.blocked(from, direction, nearest + 1e-6));
    EXPECT_FALSE(tree.blocked(from, direction, nearest - 1e-6));
  }
}

TEST(Motion, ASolidMovesInAStraightLineBetweenItsKeysAndIsOnlyThereWhenItShouldBe) {
  Solid solid;
  solid.from_s = 1;
  solid.until_s = 10;
  solid.motion = {{2, Vector3d(0, 0, 0)}, {4, Vector3d(1, 0, -2)}};
  EXPECT_FALSE(shift_at(solid, 0.5));
  EXPECT_EQ(*shift_at(solid, 1.5), Vector3d(0, 0, 0));
  EXPECT_TRUE(shift_at(solid, 3)->isApprox(Vector3d(0.5, 0, -1)));
  EXPECT_EQ(*shift_at(solid, 8), Vector3d(1, 0, -2));
  EXPECT_FALSE(shift_at(solid, 10));
}

}  // namespace
}  // namespace flogmap
