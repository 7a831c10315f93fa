// Scenes of boxes, seen exactly: views for tests and benchmarks that need no pictures.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "camera/stereo_camera.hpp"
#include "mapping/view.hpp"

namespace flogmap::test {

struct Box {
  Eigen::Vector3d low, high;  // metres, world
};

/// A hollow room with solid boxes in it.
struct BoxScene {
  Box room;
  std::vector<Box> boxes;
};

/// Distances along origin + s * direction at which a box is entered and left; entered > left if missed.
inline std::pair<double, double> cross(const Box& box, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction) {
  const Eigen::Array3d a = (box.low - origin).array() / direction.array();
  const Eigen::Array3d b = (box.high - origin).array() / direction.array();
  return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
}

/// Distance, in lengths of `direction`, to the first surface; infinite if there is none.
inline double first_hit(const BoxScene& scene, const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& direction) {
  double nearest = cross(scene.room, origin, direction).second;
  if (!(nearest > 0)) nearest = std::numeric_limits<double>::infinity();
  for (const Box& box : scene.boxes) {
    const auto [entered, left] = cross(box, origin, direction);
    if (entered <= left && entered > 0) nearest = std::min(nearest, entered);
  }
  return nearest;
}

/// What a perfect matcher would deliver from a pose.
inline View seen_from(const BoxScene& scene, const StereoCamera& camera, const SE3& world_from_camera) {
  View view;
  view.world_from_camera = world_from_camera;
  view.disparity.px = Image<float>(camera.width_px, camera.height_px, std::nanf(""));
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d pixel((x - camera.cx_px) / camera.focal_px, (y - camera.cy_px) / camera.focal_px,
                                  1);
      const double Z = first_hit(scene, world_from_camera.translation(), world_from_camera.linear() * pixel);
      if (std::isfinite(Z)) {
        view.disparity.px.at(x, y) = static_cast<float>(camera.focal_px * camera.baseline_m / Z);
      }
    }
  }
  return view;
}

/// A camera at `place` that looks along `yaw_rad` (from world x towards y), its view raised by pitch_rad
/// above the horizon and then rolled about its axis.
inline SE3 looking(const Eigen::Vector3d& place, double yaw_rad, double pitch_rad = 0, double roll_rad = 0) {
  Eigen::Matrix3d world_from_level;  // camera x right, y down, z forward, looking along world x
  world_from_level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  SE3 world_from_camera = SE3::Identity();
  world_from_camera.translation() = place;
  world_from_camera.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * world_from_level *
                               Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ());
  return world_from_camera;
}

/// A room of 6 x 5 x 2.6 m with a table, a cupboard and a shelf.
inline BoxScene furnished_room() {
  return {{{-3, -2.5, 0}, {3, 2.5, 2.6}},
          {{{0.6, -0.4, 0.70}, {1.8, 0.4, 0.74}},  // table top
           {{1.5, -2.5, 0}, {2.4, -1.9, 1.9}},     // cupboard
           {{-3, 1.0, 1.2}, {-2.7, 2.2, 1.24}},    // shelf
           {{-1.2, 1.3, 0}, {-0.7, 1.8, 0.45}}}};  // stool
}

/// Two boxes in a wide hall, as in the paper's first experiment but with a far horizon.
inline BoxScene two_boxes_in_a_hall() {
  return {{{-7, -6, -0.1}, {7, 6, 3.5}},
          {{{-0.45, -0.15, 0}, {-0.05, 0.15, 0.5}}, {{0.05, -0.2, 0}, {0.4, 0.25, 0.9}}}};
}

/// Seeded poses inside a room: every third one anything at all, the others upright with some tilt and roll;
/// the first two look straight down and are rolled by 90 degrees.
inline std::vector<SE3> random_poses(unsigned seed, int count, const Eigen::Vector3d& low,
                                     const Eigen::Vector3d& high) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1), sign(-1, 1);
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d place =
        low + Eigen::Vector3d(share(random), share(random), share(random)).cwiseProduct(high - low);
    const double pi = std::numbers::pi, wild = i % 3 == 2 ? 1.0 : 0.2;
    double pitch = sign(random) * pi / 2 * wild, roll = sign(random) * pi * wild;
    if (i == 0) pitch = -pi / 2;
    if (i == 1) roll = pi / 2;
    poses.push_back(looking(place, sign(random) * pi, pitch, roll));
  }
  return poses;
}

}  // namespace flogmap::test
