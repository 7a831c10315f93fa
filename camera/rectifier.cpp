#include "camera/rectifier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "camera/calibration/distortion.hpp"
#include "camera/grey.hpp"
#include "camera/rectifying_rotations.hpp"

namespace flogmap {
namespace {

constexpr double kMaxHalfWidth = 1.428;  // tan(55 degrees)

/// A rectangle of the plane z = 1 of the rectified camera.
struct Window {
  double left = -kMaxHalfWidth, right = kMaxHalfWidth, top = -kMaxHalfWidth, bottom = kMaxHalfWidth;
};

/// Shrinks the window until the border of the raw picture, seen through the rotation, is nowhere inside it.
void shrink_to_picture(Window& window, const CameraIntrinsics& camera, const Eigen::Matrix3d& rotation) {
  constexpr int kSteps = 64;
  const auto on_plane = [&](double x, double y) -> std::optional<Eigen::Vector2d> {
    const auto ray = ray_from_pixel(camera, {x, y});
    if (!ray) return std::nullopt;
    const Eigen::Vector3d turned = rotation * *ray;
    if (turned.z() < 0.1 * turned.norm()) return std::nullopt;  // outside any window
    return Eigen::Vector2d(turned.head<2>() / turned.z());
  };
  const double width = camera.width_px - 1, height = camera.height_px - 1;
  for (int step = 0; step <= kSteps; ++step) {
    const double x = width * step / kSteps, y = height * step / kSteps;
    if (const auto p = on_plane(0, y)) window.left = std::max(window.left, p->x());
    if (const auto p = on_plane(width, y)) window.right = std::min(window.right, p->x());
    if (const auto p = on_plane(x, 0)) window.top = std::max(window.top, p->y());
    if (const auto p = on_plane(x, height)) window.bottom = std::min(window.bottom, p->y());
  }
}

/// The widest camera whose pictures of the raw size lie inside the window; the direction with room to spare
/// is centred.
StereoCamera camera_for(const Window& window, const StereoCalibration& calibration) {
  StereoCamera camera;
  camera.width_px = calibration.left.width_px;
  camera.height_px = calibration.left.height_px;
  camera.baseline_m = calibration.right_from_left.translation().norm();
  const double width = camera.width_px - 1, height = camera.height_px - 1;
  camera.focal_px = std::max(width / (window.right - window.left), height / (window.bottom - window.top));
  camera.cx_px = width / 2 - camera.focal_px * (window.left + window.right) / 2;
  camera.cy_px = height / 2 - camera.focal_px * (window.top + window.bottom) / 2;
  return camera;
}

void check_camera(const CameraIntrinsics& camera, const std::string& where) {
  if (camera.width_px <= 0 || camera.height_px <= 0) {
    throw std::runtime_error(where + ": resolution must be > 0, got " + std::to_string(camera.width_px) +
                             "x" + std::to_string(camera.height_px));
  }
  if (!(camera.fx_px > 0) || !(camera.fy_px > 0)) {
    throw std::runtime_error(where + ": focal length must be > 0 px, got " + std::to_string(camera.fx_px) +
                             ", " + std::to_string(camera.fy_px));
  }
}

void check_pair(const StereoCalibration& calibration) {
  check_camera(calibration.left, calibration.origin + ": left camera");
  check_camera(calibration.right, calibration.origin + ": right camera");
  const Eigen::Vector3d t = calibration.right_from_left.translation();
  if (!(t.norm() > 1e-6)) {
    throw std::runtime_error(calibration.origin + ": baseline must be > 0 m, got " +
                             std::to_string(t.norm()));
  }
  if (!(-t.x() > t.tail<2>().norm())) {
    throw std::runtime_error(calibration.origin +
                             ": the right camera must stand to the right of the left one, got it at x = " +
                             std::to_string(-t.x()) + " m; left and right swapped?");
  }
  const CameraIntrinsics& left = calibration.left;
  const CameraIntrinsics& right = calibration.right;
  if (left.width_px != right.width_px || left.height_px != right.height_px) {
    throw std::runtime_error(calibration.origin + ": both cameras must have one resolution, got " +
                             std::to_string(left.width_px) + "x" + std::to_string(left.height_px) + " and " +
                             std::to_string(right.width_px) + "x" + std::to_string(right.height_px));
  }
}

/// Already one camera, side by side, without distortion: nothing is to be done.
bool is_rectified(const StereoCalibration& c) {
  const auto undistorted = [](const CameraIntrinsics& camera) {
    return camera.distortion != Distortion::equidistant &&
           std::all_of(camera.coefficients.begin(), camera.coefficients.end(),
                       [](double k) { return k == 0; });
  };
  const Eigen::Vector3d t = c.right_from_left.translation();
  constexpr double kSamePx = 1e-6;
  return undistorted(c.left) && undistorted(c.right) && std::abs(c.left.fx_px - c.left.fy_px) < kSamePx &&
         std::abs(c.left.fx_px - c.right.fx_px) < kSamePx &&
         std::abs(c.left.fy_px - c.right.fy_px) < kSamePx &&
         std::abs(c.left.cx_px - c.right.cx_px) < kSamePx &&
         std::abs(c.left.cy_px - c.right.cy_px) < kSamePx && c.right_from_left.linear().isIdentity(1e-9) &&
         t.x() < 0 && t.tail<2>().norm() < 1e-9 * t.norm();
}

StereoCamera camera_as_it_is(const StereoCalibration& c) {
  return {c.left.fx_px,    c.left.cx_px,    c.left.cy_px, c.right_from_left.translation().norm(),
          c.left.width_px, c.left.height_px};
}

}  // namespace

struct Rectifier::Maps {
  cv::Mat whole_px, fraction;  // fixed point: 16-bit pixel, 5-bit fractions

  Maps(const CameraIntrinsics& raw, const Eigen::Matrix3d& rectified_from_raw, const StereoCamera& camera) {
    cv::Mat x(camera.height_px, camera.width_px, CV_32F), y(camera.height_px, camera.width_px, CV_32F);
    const Eigen::Matrix3d raw_from_rectified = rectified_from_raw.transpose();
    for (int row = 0; row < camera.height_px; ++row) {
      for (int column = 0; column < camera.width_px; ++column) {
        const Eigen::Vector3d ray((column - camera.cx_px) / camera.focal_px,
                                  (row - camera.cy_px) / camera.focal_px, 1.0);
        const Eigen::Vector2d px = pixel_from_ray(raw, raw_from_rectified * ray);
        x.at<float>(row, column) = static_cast<float>(px.x());
        y.at<float>(row, column) = static_cast<float>(px.y());
      }
    }
    cv::convertMaps(x, y, whole_px, fraction, CV_16SC2);
  }

  Image<std::uint8_t> apply(Image<std::uint8_t>& raw) const {
    const cv::Mat grey(raw.height, raw.width, CV_8U, raw.pixels.data());
    Image<std::uint8_t> out(whole_px.cols, whole_px.rows);
    cv::Mat target(out.height, out.width, CV_8U, out.pixels.data());
    cv::remap(grey, target, whole_px, fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return out;
  }
};

Rectifier::Rectifier(const StereoCalibration& calibration) {
  check_pair(calibration);
  if (calibration.rectified || is_rectified(calibration)) {
    camera_ = camera_as_it_is(calibration);
    if (is_rectified(calibration)) return;
    // One camera, but the right picture is shifted or scaled against the left: only that is undone.
    right_ = std::make_unique<Maps>(calibration.right, Eigen::Matrix3d::Identity(), camera_);
    return;
  }
  const RectifyingRotations rotations = rectifying_rotations(calibration.right_from_left);
  Window window;
  shrink_to_picture(window, calibration.left, rotations.rectified_from_left);
  shrink_to_picture(window, calibration.right, rotations.rectified_from_right);
  if (window.right - window.left < 1e-3 || window.bottom - window.top < 1e-3) {
    throw std::runtime_error(calibration.origin +
                             ": the two cameras see nothing in common; check T_BS / R, T");
  }
  camera_ = camera_for(window, calibration);
  rectified_from_raw_left_.linear() = rotations.rectified_from_left;
  left_ = std::make_unique<Maps>(calibration.left, rotations.rectified_from_left, camera_);
  right_ = std::make_unique<Maps>(calibration.right, rotations.rectified_from_right, camera_);
}

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

RectifiedFrame Rectifier::rectify(const StereoFrame& frame) const {
  const auto one = [&](const Picture& picture, const std::unique_ptr<Maps>& maps) {
    if (picture.width != camera_.width_px || picture.height != camera_.height_px) {
      throw std::runtime_error("a picture of " + std::to_string(picture.width) + "x" +
                               std::to_string(picture.height) +
                               " px does not fit the calibration, which is for " +
                               std::to_string(camera_.width_px) + "x" + std::to_string(camera_.height_px));
    }
    Image<std::uint8_t> grey = to_grey(picture);
    return maps ? maps->apply(grey) : grey;
  };
  return {frame.timestamp_ns, one(frame.left, left_), one(frame.right, right_)};
}

}  // namespace flogmap
