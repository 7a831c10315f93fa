#include "camera/calibration/calibration_review.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <opencv2/features2d.hpp>
#include <stdexcept>
#include <utility>

#include "camera/calibration/distortion.hpp"
#include "camera/grey.hpp"
#include "camera/rectifier.hpp"
#include "camera/rectifying_rotations.hpp"

namespace flogmap {
namespace {

struct Match {
  Eigen::Vector2d left_px, right_px;  // raw
};

std::vector<Match> match_corners(const StereoFrame& frame) {
  Image<std::uint8_t> left = to_grey(frame.left), right = to_grey(frame.right);
  const cv::Ptr<cv::ORB> orb = cv::ORB::create(1500, 1.2F, 1);
  std::array<std::vector<cv::KeyPoint>, 2> corners;
  std::array<cv::Mat, 2> descriptors;
  orb->detectAndCompute(cv::Mat(left.height, left.width, CV_8U, left.pixels.data()), {}, corners[0],
                        descriptors[0]);
  orb->detectAndCompute(cv::Mat(right.height, right.width, CV_8U, right.pixels.data()), {}, corners[1],
                        descriptors[1]);
  std::vector<Match> matches;
  if (descriptors[0].empty() || descriptors[1].empty()) return matches;
  std::vector<std::vector<cv::DMatch>> best_two;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(descriptors[0], descriptors[1], best_two, 2);
  for (const auto& best : best_two) {
    constexpr float kClearly = 0.7F;  // of the second best distance: else it could be another corner
    if (best.size() < 2 || best[0].distance > kClearly * best[1].distance) continue;
    const cv::Point2f l = corners[0][static_cast<std::size_t>(best[0].queryIdx)].pt;
    const cv::Point2f r = corners[1][static_cast<std::size_t>(best[0].trainIdx)].pt;
    matches.push_back({{l.x, l.y}, {r.x, r.y}});
  }
  return matches;
}

/// Where matches fall after rectification, or nothing if the calibration cannot be a pair.
struct Rectified {
  std::vector<double> down_px;       // right row - left row
  std::vector<double> disparity_px;  // left column - right column
};

Rectified rectify(const StereoCalibration& calibration, const std::vector<Match>& matches) {
  const Rectifier rectifier(calibration);  // throws if it cannot be
  const StereoCamera& camera = rectifier.camera();
  const RectifyingRotations turn =
      calibration.rectified ? RectifyingRotations{Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()}
                            : rectifying_rotations(calibration.right_from_left);
  Rectified result;
  for (const Match& match : matches) {
    const auto left = ray_from_pixel(calibration.left, match.left_px);
    const auto right = ray_from_pixel(calibration.right, match.right_px);
    if (!left || !right) continue;
    const Eigen::Vector3d l = turn.rectified_from_left * *left, r = turn.rectified_from_right * *right;
    if (l.z() <= 0 || r.z() <= 0) continue;
    result.down_px.push_back(camera.focal_px * (r.y() / r.z() - l.y() / l.z()));
    result.disparity_px.push_back(camera.focal_px * (l.x() / l.z() - r.x() / r.z()));
  }
  return result;
}

double agreeing_share(const Rectified& rectified) {
  constexpr double kSameRowPx = 2, kBeyondInfinityPx = -2;
  if (rectified.down_px.empty()) return 0;
  std::size_t agreeing = 0;
  for (std::size_t i = 0; i < rectified.down_px.size(); ++i) {
    if (std::abs(rectified.down_px[i]) <= kSameRowPx && rectified.disparity_px[i] >= kBeyondInfinityPx)
      ++agreeing;
  }
  return static_cast<double>(agreeing) / static_cast<double>(rectified.down_px.size());
}

StereoCalibration cameras_exchanged(StereoCalibration c) {
  std::swap(c.left, c.right);
  c.right_from_left = c.right_from_left.inverse();
  return c;
}

StereoCalibration transform_inverted(StereoCalibration c) {
  c.right_from_left = c.right_from_left.inverse();
  return c;
}

std::vector<Match> pictures_exchanged(std::vector<Match> matches) {
  for (Match& match : matches) std::swap(match.left_px, match.right_px);
  return matches;
}

/// A usual mistake, undone.
struct Suspicion {
  const char* words;
  StereoCalibration calibration;
  std::vector<Match> matches;
};

std::vector<Suspicion> suspicions(const StereoCalibration& c, const std::vector<Match>& matches) {
  return {{"left and right pictures are exchanged; give them the other way round", c,
           pictures_exchanged(matches)},
          {"the calibration calls the left camera right; exchange its two cameras", cameras_exchanged(c),
           matches},
          {"the calibration's transform goes the wrong way (left from right); invert R, T",
           transform_inverted(c), matches}};
}

double share_or_zero(const StereoCalibration& calibration, const std::vector<Match>& matches) {
  try {
    return agreeing_share(rectify(calibration, matches));
  } catch (const std::runtime_error&) {
    return 0;  // not a pair at all
  }
}

/// What would explain the pictures clearly better than the calibration as it is.
void name_mix_up(const StereoCalibration& calibration, const std::vector<Match>& matches,
                 CalibrationReview& review) {
  constexpr double kClearlyMore = 0.2, kExplains = 0.5;
  double best = std::max(review.agreeing_share + kClearlyMore, kExplains);
  const char* words = nullptr;
  for (const Suspicion& suspicion : suspicions(calibration, matches)) {
    const double share = share_or_zero(suspicion.calibration, suspicion.matches);
    if (share > best) best = share, words = suspicion.words;
  }
  if (words != nullptr) review.faults.emplace_back(words);
}

double percentile(std::vector<double> values, std::size_t percent) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * percent / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void measure(const Rectified& rectified, CalibrationReview& review) {
  constexpr double kMismatchPx = 10;
  std::vector<double> vertical, signed_px;
  for (const double down : rectified.down_px) {
    if (std::abs(down) > kMismatchPx) continue;
    vertical.push_back(std::abs(down));
    signed_px.push_back(down);
  }
  review.vertical_p50_px = percentile(vertical, 50);
  review.vertical_p95_px = percentile(vertical, 95);
  review.vertical_bias_px = percentile(signed_px, 50);
  review.agreeing_share = agreeing_share(rectified);
}

std::string px(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f px", value);
  return text.data();
}

}  // namespace

CalibrationReview review_calibration(const StereoCalibration& calibration,
                                     const std::vector<StereoFrame>& frames) {
  CalibrationReview review;
  std::vector<Match> matches;
  for (const StereoFrame& frame : frames) {
    const std::vector<Match> more = match_corners(frame);
    matches.insert(matches.end(), more.begin(), more.end());
  }
  review.num_matches = matches.size();
  constexpr std::size_t kFew = 50;
  if (matches.size() < kFew) {
    review.faults.push_back(
        "only " + std::to_string(matches.size()) +
        " corners match between left and right; point the cameras at something with texture");
    return review;
  }
  std::string refused;
  try {
    measure(rectify(calibration, matches), review);
  } catch (const std::runtime_error& error) {
    refused = error.what();
  }
  name_mix_up(calibration, matches, review);
  if (!refused.empty()) review.faults.push_back(refused);
  if (!review.faults.empty()) return review;
  constexpr double kUsablePx = 1.0, kLeastShare = 0.5;
  if (review.agreeing_share < kLeastShare)
    review.faults.emplace_back(
        "most corners do not fall on the same row; this calibration is not of these cameras");
  else if (review.vertical_p50_px > kUsablePx)
    review.faults.push_back("rows differ by " + px(review.vertical_p50_px) +
                            " (median); the cameras have moved since, calibrate again");
  return review;
}

}  // namespace flogmap
