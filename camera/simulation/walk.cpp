#include "camera/simulation/walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace flogmap {
namespace {

using Eigen::Vector3d;

constexpr int kStepsPerPoint = 64;
constexpr std::size_t kSwaysPerChannel = 3;

/// Uniform cubic B-spline: smooth to the second derivative, so nothing jerks; it rounds the corners of its
/// points.
double spline_weight(int index, double t) {
  switch (index) {
    case 0:
      return (1 - t) * (1 - t) * (1 - t) / 6;
    case 1:
      return (3 * t * t * t - 6 * t * t + 4) / 6;
    case 2:
      return (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6;
    default:
      return t * t * t / 6;
  }
}

Eigen::Matrix3d looking(const Vector3d& direction, double roll_rad) {
  const Vector3d forward = direction.normalized();
  Vector3d right = forward.cross(Vector3d::UnitZ());
  if (right.norm() < 1e-6) right = Vector3d::UnitX();  // straight up or down
  right.normalize();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return axes * Eigen::AngleAxisd(roll_rad, Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

Walk::Walk(const Path& path, double rate_hz, std::uint64_t seed) : path_(path), rate_hz_(rate_hz) {
  const std::size_t needed = path_.steps ? 1 : path_.closed ? 3 : 2;
  if (path_.points.size() < needed) {
    throw std::runtime_error("path.points must be at least " + std::to_string(needed) + ", got " +
                             std::to_string(path_.points.size()));
  }
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (std::size_t i = 0; i < 6 * kSwaysPerChannel; ++i) {
    const double lowest = 0.25 * std::pow(2.6, static_cast<double>(i % kSwaysPerChannel));
    sways_.push_back({lowest * uniform(0.8, 1.25), uniform(0, 2 * std::numbers::pi),
                      1 / (1.0 + static_cast<double>(i % kSwaysPerChannel))});
  }
  if (path_.steps) {
    round_s_ = static_cast<double>(path_.points.size()) / rate_hz_;
    return;
  }
  const std::size_t segments = path_.points.size() - (path_.closed ? 0 : 1);
  length_m_.push_back(0);
  for (std::size_t i = 1; i <= segments * kStepsPerPoint; ++i) {
    const Vector3d a = on_curve(static_cast<double>(i - 1) / kStepsPerPoint).position_m;
    const Vector3d b = on_curve(static_cast<double>(i) / kStepsPerPoint).position_m;
    length_m_.push_back(length_m_.back() + (b - a).norm());
  }
  round_s_ = length_m_.back() / path_.speed_m_s;
}

PathPoint Walk::on_curve(double parameter) const {
  const auto count = static_cast<std::ptrdiff_t>(path_.points.size());
  const double whole = std::floor(parameter);
  PathPoint sum;
  sum.position_m = sum.look_at_m = Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    std::ptrdiff_t at = static_cast<std::ptrdiff_t>(whole) + i - 1;
    at = path_.closed ? (at % count + count) % count : std::clamp<std::ptrdiff_t>(at, 0, count - 1);
    const double weight = spline_weight(i, parameter - whole);
    sum.position_m += weight * path_.points[at].position_m;
    sum.look_at_m += weight * path_.points[at].look_at_m;
    sum.roll_rad += weight * path_.points[at].roll_rad;
  }
  return sum;
}

double Walk::parameter(double time_s) const {
  double walked = std::max(time_s, 0.0) * path_.speed_m_s;
  if (path_.closed) {
    walked = std::fmod(walked, length_m_.back());
  } else {
    walked = std::min(walked, length_m_.back());
  }
  const auto next = std::upper_bound(length_m_.begin() + 1, length_m_.end() - 1, walked);
  const double before = *std::prev(next);
  const double share = *next > before ? (walked - before) / (*next - before) : 0;
  return (static_cast<double>(next - length_m_.begin()) - 1 + share) / kStepsPerPoint;
}

double Walk::unsteadiness(std::size_t channel, double time_s) const {
  double sum = 0, power = 0;
  for (std::size_t i = 0; i < kSwaysPerChannel; ++i) {
    const Sway& sway = sways_[channel * kSwaysPerChannel + i];
    sum += sway.share * std::sin(2 * std::numbers::pi * sway.frequency_hz * time_s + sway.phase_rad);
    power += sway.share * sway.share / 2;
  }
  return sum / std::sqrt(power);
}

Eigen::Isometry3d Walk::pose(double time_s) const {
  PathPoint point;
  if (path_.steps) {
    const auto index = static_cast<std::int64_t>(std::llround(std::max(time_s, 0.0) * rate_hz_));
    const auto count = static_cast<std::int64_t>(path_.points.size());
    point = path_.points[path_.closed ? index % count : std::min(index, count - 1)];
  } else {
    point = on_curve(parameter(time_s));
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const auto swayed = [&](std::size_t from) {
    return Vector3d(unsteadiness(from, time_s), unsteadiness(from + 1, time_s),
                    unsteadiness(from + 2, time_s));
  };
  pose.translation() = point.position_m + path_.tremor_m * swayed(0);
  const Vector3d turn = path_.tremor_rad * swayed(3);
  pose.linear() = looking(point.look_at_m - point.position_m, point.roll_rad);
  if (turn.norm() > 0) pose.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  return pose;
}

}  // namespace flogmap
