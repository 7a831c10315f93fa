// A room with textured walls, rendered with exact disparity: known motion for the odometry's tests.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "camera/stereo_camera.hpp"
#include "camera/stereo_frame.hpp"
#include "mapping/view.hpp"

namespace flogmap::test {

inline constexpr StereoCamera kRoomCamera{250, 159.5, 119.5, 0.12, 320, 240};

/// A pair and its disparity, as the odometry takes them.
struct RenderedFrame {
  RectifiedFrame pair;
  DisparityImage disparity;
};

/// Random but repeatable number in [0, 1) of a lattice point.
inline double lattice_value(std::int64_t x, std::int64_t y, std::int64_t seed) {
  auto h = static_cast<std::uint64_t>(x * 0x8da6b343LL + y * 0xd8163841LL + seed * 0xcb1ab31fLL);
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1p-53;
}

/// Smooth noise with features about one unit large.
inline double value_noise(double x, double y, std::int64_t seed) {
  const auto u = static_cast<std::int64_t>(std::floor(x)), v = static_cast<std::int64_t>(std::floor(y));
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double a = smooth(x - static_cast<double>(u)), b = smooth(y - static_cast<double>(v));
  const double upper = (1 - a) * lattice_value(u, v, seed) + a * lattice_value(u + 1, v, seed);
  const double lower = (1 - a) * lattice_value(u, v + 1, seed) + a * lattice_value(u + 1, v + 1, seed);
  return (1 - b) * upper + b * lower;
}

/// The inside of a box. World: z up, floor at z = 0, x and y within +-half_m.
struct TexturedRoom {
  Eigen::Vector3d half_m{3, 2.5, 0};
  double height_m = 2.6;
  double contrast = 1;  // 0: nothing to see
  double feature_size_m = 0.05;
  std::int64_t seed = 1;

  [[nodiscard]] double grey(const Eigen::Vector2d& at, int wall) const {
    double sum = 0, weight = 1;
    for (double size = 4 * feature_size_m; size > 0.4 * feature_size_m; size /= 2, weight *= 0.8) {
      sum += weight * (value_noise(at.x() / size, at.y() / size, seed * 100 + wall) - 0.5);
    }
    return 128 + 90 * contrast * sum;
  }

  /// Grey value seen along a ray, and how many times the direction it is away.
  [[nodiscard]] std::pair<double, double> look(const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d low(-half_m.x(), -half_m.y(), 0), high(half_m.x(), half_m.y(), height_m);
    double nearest = std::numeric_limits<double>::infinity();
    int wall = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0) continue;
      const double s = ((direction[axis] > 0 ? high : low)[axis] - from[axis]) / direction[axis];
      if (s >= nearest) continue;
      nearest = s;
      wall = 2 * axis + (direction[axis] > 0 ? 1 : 0);
    }
    const Eigen::Vector3d hit = from + nearest * direction;
    const int axis = wall / 2;
    return {grey({hit[(axis + 1) % 3], hit[(axis + 2) % 3]}, wall), nearest};
  }

  [[nodiscard]] RenderedFrame render(const SE3& world_from_camera, std::int64_t timestamp_ns = 0,
                                     const StereoCamera& camera = kRoomCamera) const {
    RenderedFrame frame;
    frame.pair.timestamp_ns = timestamp_ns;
    frame.pair.left = frame.pair.right = Image<std::uint8_t>(camera.width_px, camera.height_px);
    frame.disparity.px = Image<float>(camera.width_px, camera.height_px);
    const Eigen::Vector3d right_eye = world_from_camera * Eigen::Vector3d(camera.baseline_m, 0, 0);
    for (int y = 0; y < camera.height_px; ++y) {
      for (int x = 0; x < camera.width_px; ++x) {
        const Eigen::Vector3d ray((x - camera.cx_px) / camera.focal_px, (y - camera.cy_px) / camera.focal_px,
                                  1);
        const Eigen::Vector3d direction = world_from_camera.linear() * ray;
        const auto [left, Z] = look(world_from_camera.translation(), direction);
        frame.pair.left.at(x, y) = static_cast<std::uint8_t>(std::clamp(left + 0.5, 0.0, 255.0));
        frame.pair.right.at(x, y) =
            static_cast<std::uint8_t>(std::clamp(look(right_eye, direction).first + 0.5, 0.0, 255.0));
        frame.disparity.px.at(x, y) = static_cast<float>(camera.focal_px * camera.baseline_m / Z);
      }
    }
    return frame;
  }
};

/// A camera at a place that looks along the floor in the direction `yaw`, then turned by pitch and roll.
inline SE3 camera_at(const Eigen::Vector3d& place, double yaw_rad, double pitch_rad = 0,
                     double roll_rad = 0) {
  Eigen::Matrix3d level_from_camera;  // x right, y down, z forward -> x forward, y left, z up
  level_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  SE3 pose = SE3::Identity();
  pose.translation() = place;
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                  level_from_camera *
                  Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
                  Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

inline double angle_deg(const SE3& motion) {
  return Eigen::AngleAxisd(motion.linear()).angle() * 57.29577951308232;
}

}  // namespace flogmap::test
