#include "camera/board_calibration/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>

#include "camera/board_calibration/picture_areas.hpp"
#include "camera/calibration/distortion.hpp"
#include "camera/rectifier.hpp"
#include "camera/rectifying_rotations.hpp"

namespace flogmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGoodEpipolarPx = 0.5, kUsableEpipolarPx = 1.0;  // p95; a matcher searches one row only
constexpr double kGoodRmsPx = 0.5, kUsableRmsPx = 1.5;

double percentile_95(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + std::ssize(values) * 95 / 100;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::string text(const char* format, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, value);
  return buffer.data();
}

/// Areas of a camera's picture where the board was never seen.
void advise_on_coverage(const CalibrationResult& result, bool right, std::vector<std::string>& advice) {
  const CameraIntrinsics& camera = right ? result.calibration.right : result.calibration.left;
  AreaCounts counts{};
  for (const CornerError& corner : result.corners) {
    if (corner.right == right && corner.used)
      ++counts[area_of(corner.pixel, camera.width_px, camera.height_px)];
  }
  std::string empty;
  for (std::size_t area = 0; area < counts.size(); ++area) {
    if (counts[area] == 0) empty += (empty.empty() ? "" : ", ") + area_name(area);
  }
  if (empty.empty()) return;
  advice.push_back(std::string("the ") + (right ? "right" : "left") +
                   " camera never saw the board at: " + empty + "; hold it there too");
}

/// Boards that all face the camera tell focal length and distance apart badly.
void advise_on_tilt(const CalibrationResult& result, std::vector<std::string>& advice) {
  double widest = 0;
  for (const Eigen::Isometry3d& a : result.left_from_board) {
    for (const Eigen::Isometry3d& b : result.left_from_board)
      widest = std::max(widest, std::acos(std::min(1.0, std::abs(a.linear().col(2).dot(b.linear().col(2))))));
  }
  constexpr double kEnough = 25 * kDegree;
  if (widest < kEnough)
    advice.push_back("all boards face the same way (within " + text("%.0f", widest / kDegree) +
                     " degrees); tilt it by 30 degrees to the left, right, up and down");
}

/// Pairs that fit much worse than the others: moved, blurred, out of step.
void advise_on_pairs(const CalibrationResult& result, const std::vector<std::string>& names,
                     std::vector<std::string>& advice) {
  std::map<std::size_t, std::pair<double, int>> sums;
  for (const CornerError& corner : result.corners) {
    sums[corner.pair].first += corner.error_px.squaredNorm();
    ++sums[corner.pair].second;
  }
  std::vector<std::pair<double, std::size_t>> errors;
  for (const auto& [pair, sum] : sums) errors.emplace_back(std::sqrt(sum.first / sum.second), pair);
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  const double limit = std::max(0.5, 3 * errors[errors.size() / 2].first);
  std::string bad;
  for (const auto& [error, pair] : errors) {
    if (error > limit)
      bad += (bad.empty() ? "" : ", ") + names.at(pair) + " (" + text("%.2g", error) + " px)";
  }
  if (!bad.empty()) advice.push_back("take these again, or leave them out: " + bad);
}

void advise_on_numbers(const CalibrationVerdict& verdict, double focal_sigma,
                       std::vector<std::string>& advice) {
  constexpr std::size_t kFew = 10;
  if (verdict.epipolar_p95_px > kGoodEpipolarPx)
    advice.push_back("rows differ by up to " + text("%.2f", verdict.epipolar_p95_px) +
                     " px; are both cameras exposed at the same moment, is anything loose?");
  if (verdict.rms_px > kGoodRmsPx)
    advice.push_back("corners are off by " + text("%.2f", verdict.rms_px) +
                     " px; is the board flat, in focus, at rest, and --board and --model right?");
  if (verdict.num_pairs < kFew)
    advice.push_back("only " + std::to_string(verdict.num_pairs) + " pairs; 15 to 30 are better");
  constexpr double kCertain = 0.005;
  if (focal_sigma > kCertain)
    advice.push_back("the focal length is known to " + text("%.1f", 100 * focal_sigma) +
                     " % only; tilt the board more and come nearer");
}

CalibrationGrade grade_of(const CalibrationVerdict& verdict, bool advised) {
  if (verdict.epipolar_p95_px > kUsableEpipolarPx || verdict.rms_px > kUsableRmsPx)
    return CalibrationGrade::redo;
  const bool good = verdict.epipolar_p95_px <= kGoodEpipolarPx && verdict.rms_px <= kGoodRmsPx && !advised;
  return good ? CalibrationGrade::good : CalibrationGrade::usable;
}

}  // namespace

std::vector<double> epipolar_errors_px(const CalibrationResult& result) {
  const StereoCalibration& calibration = result.calibration;
  const RectifyingRotations turn = rectifying_rotations(calibration.right_from_left);
  const double focal_px = Rectifier(calibration).camera().focal_px;
  std::map<std::pair<std::size_t, int>, std::array<std::optional<double>, 2>> rows;
  for (const CornerError& corner : result.corners) {
    if (!corner.used) continue;
    const auto ray = ray_from_pixel(corner.right ? calibration.right : calibration.left, corner.pixel);
    if (!ray) continue;
    const Eigen::Vector3d turned =
        (corner.right ? turn.rectified_from_right : turn.rectified_from_left) * *ray;
    if (turned.z() > 0)
      rows[{corner.pair, corner.point}][corner.right ? 1 : 0] = focal_px * turned.y() / turned.z();
  }
  std::vector<double> errors;
  for (const auto& [which, both] : rows) {
    if (both[0] && both[1]) errors.push_back(std::abs(*both[0] - *both[1]));
  }
  return errors;
}

CalibrationVerdict judge(const CalibrationResult& result, const std::vector<std::string>& names) {
  CalibrationVerdict verdict;
  verdict.rms_px = result.rms_px;
  verdict.epipolar_p95_px = percentile_95(epipolar_errors_px(result));
  verdict.baseline_m = result.calibration.right_from_left.translation().norm();
  verdict.baseline_sigma_m = result.baseline_sigma_m;
  const StereoCamera camera = Rectifier(result.calibration).camera();
  verdict.field_of_view_rad = 2 * std::atan(camera.width_px / (2 * camera.focal_px));
  verdict.num_pairs = names.size();
  for (const CornerError& corner : result.corners)
    ++(corner.used ? verdict.num_corners : verdict.num_left_out);
  advise_on_numbers(verdict, result.focal_sigma, verdict.advice);
  advise_on_pairs(result, names, verdict.advice);
  advise_on_tilt(result, verdict.advice);
  advise_on_coverage(result, false, verdict.advice);
  advise_on_coverage(result, true, verdict.advice);
  verdict.grade = grade_of(verdict, !verdict.advice.empty());
  return verdict;
}

const char* grade_name(CalibrationGrade grade) {
  switch (grade) {
    case CalibrationGrade::good:
      return "good";
    case CalibrationGrade::usable:
      return "usable";
    case CalibrationGrade::redo:
      break;
  }
  return "redo";
}

}  // namespace flogmap
