// Pictures of calibration boards with exactly known truth: every pixel is the mean of several rays.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "camera/board_calibration/board.hpp"
#include "camera/board_calibration/markers.hpp"
#include "camera/calibration/distortion.hpp"
#include "camera/calibration/stereo_calibration.hpp"

namespace flogmap::testing {

/// Brightness of the board at a point of its plane, in the coordinates of board_points(); 0 to 255.
using BoardPaint = std::function<double(double x_m, double y_m)>;

inline constexpr double kBlack = 30, kWhite = 220, kTable = 120;

inline BoardPaint paint_chessboard(const BoardSpec& spec) {
  return [spec](double x, double y) {
    const int column = static_cast<int>(std::floor(x / spec.square_m)) + 1;
    const int row = static_cast<int>(std::floor(y / spec.square_m)) + 1;
    if (column < 0 || row < 0 || column > spec.columns || row > spec.rows) {
      return column < -1 || row < -1 || column > spec.columns + 1 || row > spec.rows + 1 ? kTable : kWhite;
    }
    return (row + column) % 2 == 0 ? kBlack : kWhite;
  };
}

/// One marker in [0, 1) x [0, 1), y down.
inline double paint_marker(const Image<std::uint8_t>& bits, double u, double v) {
  const int x = static_cast<int>(u * bits.width), y = static_cast<int>(v * bits.height);
  return bits.contains(x, y) && bits.at(x, y) > 127 ? kWhite : kBlack;
}

inline std::vector<Image<std::uint8_t>> marker_bits(const std::string& dictionary, int count, int border,
                                                    int inner_bits) {
  std::vector<Image<std::uint8_t>> bits;
  for (int id = 0; id < count; ++id)
    bits.push_back(draw_marker(dictionary, id, border, inner_bits + 2 * border));
  return bits;
}

/// First square black, markers on the white ones, row by row.
inline BoardPaint paint_charuco(const BoardSpec& spec, const std::string& dictionary, int inner_bits) {
  const auto bits = marker_bits(dictionary, spec.columns * spec.rows / 2, 1, inner_bits);
  return [spec, bits](double x, double y) {
    const int column = static_cast<int>(std::floor(x / spec.square_m)) + 1;
    const int row = static_cast<int>(std::floor(y / spec.square_m)) + 1;
    if (column < 0 || row < 0 || column >= spec.columns || row >= spec.rows) return kWhite;
    if ((row + column) % 2 == 0) return kBlack;
    int id = 0;
    for (int square = 0; square < row * spec.columns + column; ++square)
      id += (square / spec.columns + square % spec.columns) % 2;
    const double margin = (1 - spec.marker_share) / 2;
    const double u = (x / spec.square_m - (column - 1) - margin) / spec.marker_share;
    const double v = (y / spec.square_m - (row - 1) - margin) / spec.marker_share;
    return u < 0 || v < 0 || u >= 1 || v >= 1 ? kWhite
                                              : paint_marker(bits[static_cast<std::size_t>(id)], u, v);
  };
}

/// As Kalibr prints it: tags upright, counted from the lower left upwards, little squares where tags meet.
inline BoardPaint paint_tags(const BoardSpec& spec, int border) {
  constexpr int kInnerBits = 6;
  const auto bits = marker_bits("APRILTAG_36h11", spec.columns * spec.rows, border, kInnerBits);
  return [spec, bits](double x, double y) {  // y up
    const double pitch = spec.square_m * (1 + spec.tag_gap_share);
    const int column = static_cast<int>(std::floor(x / pitch)), row = static_cast<int>(std::floor(y / pitch));
    const double u = (x - column * pitch) / spec.square_m, v = (y - row * pitch) / spec.square_m;
    const bool in_board = column >= 0 && row >= 0 && column < spec.columns && row < spec.rows;
    if (u >= 1 && v >= 1) {
      const bool corner = column >= -1 && row >= -1 && column < spec.columns && row < spec.rows;
      return corner ? kBlack : kWhite;
    }
    if (u >= 1 || v >= 1 || !in_board) return kWhite;
    return paint_marker(bits[static_cast<std::size_t>(row * spec.columns + column)], u, 1 - v);
  };
}

/// A camera's rays, several per pixel, computed once for all its pictures.
class BoardCamera {
 public:
  explicit BoardCamera(const CameraIntrinsics& camera) : camera_(camera) {
    for (int y = 0; y < camera.height_px; ++y) {
      for (int x = 0; x < camera.width_px; ++x) {
        for (int sample = 0; sample < kSide * kSide; ++sample) {
          const Eigen::Vector2d pixel(x - 0.5 + (sample % kSide + 0.5) / kSide,
                                      y - 0.5 + (sample / kSide + 0.5) / kSide);
          rays_.push_back(ray_from_pixel(camera, pixel).value_or(Eigen::Vector3d::Zero()));
        }
      }
    }
  }

  [[nodiscard]] Image<std::uint8_t> picture(const BoardPaint& paint,
                                            const Eigen::Isometry3d& camera_from_board,
                                            std::mt19937& random) const {
    const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
    const Eigen::Vector3d eye = board_from_camera.translation();
    std::normal_distribution<double> noise(0, 1);
    Image<std::uint8_t> picture(camera_.width_px, camera_.height_px);
    for (std::size_t i = 0; i < picture.size(); ++i) {
      double sum = 0;
      for (std::size_t sample = 0; sample < kSide * kSide; ++sample) {
        const Eigen::Vector3d ray = board_from_camera.linear() * rays_[i * kSide * kSide + sample];
        const double distance = -eye.z() / ray.z();
        sum += distance > 0 ? paint(eye.x() + distance * ray.x(), eye.y() + distance * ray.y()) : kTable;
      }
      picture.pixels[i] = static_cast<std::uint8_t>(
          std::clamp(std::round(sum / (kSide * kSide) + noise(random)), 0.0, 255.0));
    }
    return picture;
  }

 private:
  static constexpr int kSide = 3;
  CameraIntrinsics camera_;
  std::vector<Eigen::Vector3d> rays_;
};

/// Poses of a board held in front of a camera: all over the picture, near and far, tilted to all sides.
/// `near`: the shortest distance in diagonals of the board; `reach`: how far to the side, as a share of it.
inline std::vector<Eigen::Isometry3d> board_poses(const BoardSpec& spec, int count, double near, double reach,
                                                  bool y_is_up) {
  const std::vector<Eigen::Vector3d> points = board_points(spec);
  const Eigen::Vector3d centre = (points.front() + points.back()) / 2;
  const double size = (points.front() - points.back()).norm();
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < count; ++i) {
    const double turn = 2.4 * i;  // the golden angle spreads directions evenly
    const double tilt = 0.15 + 0.5 * ((i * 7) % count) / count;
    const double distance = size * near * (1.0 + 0.6 * ((i * 5) % count) / count);
    const double aside = reach * std::sqrt((i + 0.5) / count);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = distance * Eigen::Vector3d(aside * std::cos(turn), 0.75 * aside * std::sin(turn), 1);
    pose.rotate(Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(1.7 * turn), std::sin(1.7 * turn), 0)));
    if (y_is_up) pose.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
    pose.translate(-centre);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace flogmap::testing
