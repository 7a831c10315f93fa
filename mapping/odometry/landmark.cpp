#include "mapping/odometry/landmark.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "mapping/odometry/frame_features.hpp"

namespace flogmap {
namespace {

constexpr double kLeastCorrelation = 0.75;
constexpr double kNearestZ_m = 0.05;
constexpr double kCornerSigma_px = 0.05;  // the corner is where its patch says: only numerical noise

/// How a small piece of the landmark's surface is seen by the current camera: from offsets in the anchor's
/// picture to those of x, y and d here.
Eigen::Matrix<double, 3, 2> current_from_anchor(const StereoCamera& camera, const Landmark& landmark,
                                                const SE3& camera_from_anchor, const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 3, 2> along_surface;
  along_surface << Eigen::Matrix2d::Identity(), landmark.slant.transpose();
  return project_jacobian(camera, p) * camera_from_anchor.linear() *
         triangulate_jacobian(camera, landmark.anchor_pixel) * along_surface;
}

bool plausible_warp(const Eigen::Matrix2d& warp) {
  const double area = std::abs(warp.determinant());
  return warp.allFinite() && area > 0.15 && area < 6;
}

/// How much a picture was stretched, enlarged and sheared: the distance to the nearest turn.
double change_of(const Eigen::Matrix2d& now_from_anchor) {
  const double angle = std::atan2(now_from_anchor(1, 0) - now_from_anchor(0, 1), now_from_anchor.trace());
  return (now_from_anchor - Eigen::Rotation2Dd(angle).toRotationMatrix()).norm();
}

}  // namespace

Landmark make_landmark(const StereoCamera& camera, const RectifiedFrame& frame,
                       const SE3& odometry_from_camera, const StereoPixel& pixel, const Slant& slant,
                       std::int64_t id, double disparity_sigma_px) {
  const Eigen::Matrix3d J = odometry_from_camera.linear() * triangulate_jacobian(camera, pixel);
  const double xy = kCornerSigma_px * kCornerSigma_px;
  const Eigen::Vector3d noise(xy, xy, disparity_sigma_px * disparity_sigma_px);
  return {.id = id,
          .patch = PatchSource(frame.left, pixel.head<2>()),
          .odometry_from_anchor = odometry_from_camera,
          .anchor_pixel = pixel,
          .slant = slant,
          .in_odometry = odometry_from_camera * triangulate(camera, pixel),
          .covariance = J * noise.asDiagonal() * J.transpose(),
          .seen = {{odometry_from_camera.inverse(), pixel}}};
}

std::optional<StereoPixel> expected_pixel(const StereoCamera& camera, const Landmark& landmark,
                                          const SE3& camera_from_odometry) {
  const Eigen::Vector3d p = camera_from_odometry * landmark.in_odometry;
  if (p.z() < kNearestZ_m) return std::nullopt;
  const StereoPixel s = project(camera, p);
  constexpr double kMargin = PatchSource::kMargin;
  const bool inside = s.x() - s.z() >= kMargin && s.x() < camera.width_px - kMargin && s.y() >= kMargin &&
                      s.y() < camera.height_px - kMargin;
  return inside ? std::optional(s) : std::nullopt;
}

std::optional<Sighting> find_landmark(const StereoCamera& camera, const RectifiedFrame& frame,
                                      const Landmark& landmark, const SE3& camera_from_odometry,
                                      double radius_px) {
  const auto expected = expected_pixel(camera, landmark, camera_from_odometry);
  if (!expected) return std::nullopt;
  const Eigen::Vector3d p = camera_from_odometry * landmark.in_odometry;
  const SE3 camera_from_anchor = camera_from_odometry * landmark.odometry_from_anchor;
  const auto seen_now = current_from_anchor(camera, landmark, camera_from_anchor, p);
  const Eigen::Matrix2d warp = seen_now.topRows<2>().inverse();
  if (!plausible_warp(warp)) return std::nullopt;
  const auto left = PatchAligner(landmark.patch, warp).find(frame.left, expected->head<2>(), radius_px);
  if (!left || left->correlation < kLeastCorrelation) return std::nullopt;
  const auto disparity =
      refine_disparity(frame, left->px, expected->z(), (seen_now.row(2) * warp).transpose());
  if (!disparity) return std::nullopt;
  return Sighting{landmark.id, {left->px.x(), left->px.y(), *disparity}, change_of(seen_now.topRows<2>())};
}

}  // namespace flogmap
