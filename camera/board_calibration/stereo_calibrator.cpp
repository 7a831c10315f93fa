#include "camera/board_calibration/stereo_calibrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <stdexcept>

#include "camera/board_calibration/bundle.hpp"
#include "camera/calibration/distortion.hpp"

namespace flogmap {
namespace {

using Board = std::vector<Eigen::Vector3d>;

constexpr std::size_t kFewestPoints = 8;  // in one picture
constexpr std::size_t kFewestPairs = 3;
constexpr std::size_t kPairsToTryWith = 10;
constexpr int kStepsToTry = 15;

CameraIntrinsics first_guess(const CalibratorOptions& options, double focal_share) {
  CameraIntrinsics camera;
  camera.width_px = options.width_px;
  camera.height_px = options.height_px;
  camera.fx_px = camera.fy_px = focal_share * options.width_px;
  camera.cx_px = (options.width_px - 1) / 2.0;
  camera.cy_px = (options.height_px - 1) / 2.0;
  camera.distortion = options.model;
  constexpr std::size_t kRadtan = 5, kRational = 8, kFisheye = 4;
  camera.coefficients.assign(options.model == Distortion::rational      ? kRational
                             : options.model == Distortion::equidistant ? kFisheye
                                                                        : kRadtan,
                             0.0);
  return camera;
}

/// camera_from_board from one view, by plane-to-plane mapping.
std::optional<Eigen::Isometry3d> board_pose(const CameraIntrinsics& camera, const BoardView& view,
                                            const Board& board) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> rays;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    const auto ray = ray_from_pixel(camera, view.pixels[i]);
    if (!ray || ray->z() < 0.1 * ray->norm()) continue;
    const Eigen::Vector3d& p = board[static_cast<std::size_t>(view.points[i])];
    points.emplace_back(p.x(), p.y(), p.z());
    rays.emplace_back(ray->x() / ray->z(), ray->y() / ray->z());
  }
  if (points.size() < kFewestPoints) return std::nullopt;
  cv::Vec3d rotation, translation;
  try {
    if (!cv::solvePnP(points, rays, cv::Matx33d::eye(), cv::noArray(), rotation, translation, false,
                      cv::SOLVEPNP_IPPE))
      return std::nullopt;
  } catch (const cv::Exception&) {  // all points on one line
    return std::nullopt;
  }
  cv::Matx33d R;
  cv::Rodrigues(rotation, R);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) pose(r, c) = R(r, c);
    pose(r, 3) = translation[r];
  }
  return pose.matrix().allFinite() ? std::optional(pose) : std::nullopt;
}

/// The pose that the others agree with best: the least sum of distances to all.
Eigen::Isometry3d most_agreed(const std::vector<Eigen::Isometry3d>& poses) {
  std::size_t best = 0;
  double best_sum = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    double sum = 0;
    for (const Eigen::Isometry3d& other : poses) {
      const Eigen::Isometry3d between = poses[i].inverse() * other;
      const double turn = Eigen::AngleAxisd(between.linear()).angle();
      const double scale = std::max(poses[i].translation().norm(), 1e-9);
      sum +=
          std::min(1.0, turn) + std::min(1.0, (poses[i].translation() - other.translation()).norm() / scale);
    }
    if (sum < best_sum) best = i, best_sum = sum;
  }
  return poses[best];
}

std::optional<Bundle> starting_bundle(const Board& board, const std::vector<BoardPair>& pairs,
                                      const CameraIntrinsics& camera) {
  std::vector<std::optional<Eigen::Isometry3d>> left, right;
  std::vector<Eigen::Isometry3d> relative;
  for (const BoardPair& pair : pairs) {
    left.push_back(board_pose(camera, pair.left, board));
    right.push_back(board_pose(camera, pair.right, board));
    if (left.back() && right.back()) relative.push_back(*right.back() * left.back()->inverse());
  }
  if (relative.empty()) return std::nullopt;
  Bundle bundle{camera, camera, most_agreed(relative), {}};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (left[i])
      pose = *left[i];
    else if (right[i])
      pose = bundle.right_from_left.inverse() * *right[i];
    bundle.left_from_board.push_back(pose);
  }
  return bundle;
}

std::vector<Observation> observations_of(const std::vector<BoardPair>& pairs) {
  std::vector<Observation> observations;
  for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
    for (const bool right : {false, true}) {
      const BoardView& view = right ? pairs[pair].right : pairs[pair].left;
      if (view.points.size() < kFewestPoints) continue;
      for (std::size_t i = 0; i < view.points.size(); ++i)
        observations.push_back({pair, right, view.points[i], view.pixels[i]});
    }
  }
  return observations;
}

/// Pairs evenly spread over the series.
std::vector<BoardPair> some_of(const std::vector<BoardPair>& pairs) {
  if (pairs.size() <= kPairsToTryWith) return pairs;
  std::vector<BoardPair> some;
  for (std::size_t i = 0; i < kPairsToTryWith; ++i) some.push_back(pairs[i * pairs.size() / kPairsToTryWith]);
  return some;
}

/// The cameras and their relation, roughly: of several focal lengths the one from which a few pairs are
/// explained best.
Bundle rough_solution(const Board& board, const std::vector<BoardPair>& pairs,
                      const CalibratorOptions& options) {
  const bool fisheye = options.model == Distortion::equidistant;
  const std::vector<double> shares = fisheye ? std::vector{0.25, 0.33, 0.45, 0.6, 0.9, 1.4}
                                             : std::vector{0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0};
  const std::vector<BoardPair> some = some_of(pairs);
  const std::vector<Observation> observations = observations_of(some);
  std::optional<Bundle> best;
  double best_cost = std::numeric_limits<double>::max();
  for (const double share : shares) {
    auto bundle = starting_bundle(board, some, first_guess(options, share));
    if (!bundle) continue;
    constexpr double kAlmostQuadratic = 20;  // px: everything is far off at first
    const double cost =
        solve(*bundle, observations, board, {.max_steps = kStepsToTry, .huber_px = kAlmostQuadratic});
    if (cost < best_cost) best = std::move(bundle), best_cost = cost;
  }
  if (!best) throw std::runtime_error("no pair shows the board to both cameras well enough");
  return *best;
}

/// All pairs, with the cameras of a rough solution.
Bundle with_all_pairs(const Bundle& rough, const Board& board, const std::vector<BoardPair>& pairs) {
  Bundle bundle = rough;
  bundle.left_from_board.clear();
  for (const BoardPair& pair : pairs) {
    auto pose = board_pose(rough.left, pair.left, board);
    if (!pose) {
      pose = board_pose(rough.right, pair.right, board);
      if (pose) pose = rough.right_from_left.inverse() * *pose;
    }
    bundle.left_from_board.push_back(pose.value_or(Eigen::Isometry3d::Identity()));
  }
  return bundle;
}

std::vector<CornerError> errors_of(const Bundle& bundle, const std::vector<Observation>& observations,
                                   const Board& board) {
  std::vector<CornerError> errors;
  for (const Observation& seen : observations) {
    const auto pixel = predict(bundle, seen, board[static_cast<std::size_t>(seen.point)]);
    constexpr double kFarOff = 1e6;
    const Eigen::Vector2d error =
        pixel ? Eigen::Vector2d(*pixel - seen.pixel) : Eigen::Vector2d(kFarOff, kFarOff);
    errors.push_back({seen.pair, seen.right, seen.point, seen.pixel, error, true});
  }
  return errors;
}

/// Marks what is too far off for a corner of this board: more than six times the median, and a pixel.
void leave_out_outliers(std::vector<CornerError>& corners) {
  std::vector<double> lengths;
  for (const CornerError& corner : corners) lengths.push_back(corner.error_px.norm());
  const auto middle = lengths.begin() + std::ssize(lengths) / 2;
  std::nth_element(lengths.begin(), middle, lengths.end());
  const double limit = std::max(1.0, 6 * *middle);
  for (CornerError& corner : corners) corner.used = corner.error_px.norm() <= limit;
}

double rms(const std::vector<CornerError>& corners) {
  double sum = 0, count = 0;
  for (const CornerError& corner : corners) {
    if (corner.used) sum += corner.error_px.squaredNorm(), ++count;
  }
  return std::sqrt(sum / std::max(count, 1.0));
}

std::vector<Observation> used_ones(const std::vector<Observation>& all,
                                   const std::vector<CornerError>& corners) {
  std::vector<Observation> used;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (corners[i].used) used.push_back(all[i]);
  }
  return used;
}

}  // namespace

CalibrationResult calibrate_stereo(const Board& board, const std::vector<BoardPair>& pairs,
                                   const CalibratorOptions& options) {
  if (pairs.size() < kFewestPairs) {
    throw std::runtime_error("only " + std::to_string(pairs.size()) + " pairs show the board; at least " +
                             std::to_string(kFewestPairs) + " are needed, 15 or more are good");
  }
  const auto report = [&](double share) {
    if (options.on_progress) options.on_progress(share);
  };
  Bundle bundle = with_all_pairs(rough_solution(board, pairs, options), board, pairs);
  const std::vector<Observation> observations = observations_of(pairs);
  const BundleOptions robust{
      .max_steps = 60, .huber_px = 1, .on_step = [&](int step) { report(step / 120.0); }};
  solve(bundle, observations, board, robust);
  CalibrationResult result;
  result.corners = errors_of(bundle, observations, board);
  leave_out_outliers(result.corners);
  const std::vector<Observation> used = used_ones(observations, result.corners);
  solve(bundle, used, board,
        {.max_steps = 60, .huber_px = 1, .on_step = [&](int step) { report(0.5 + step / 120.0); }});
  std::vector<CornerError> final_errors = errors_of(bundle, observations, board);
  for (std::size_t i = 0; i < final_errors.size(); ++i) final_errors[i].used = result.corners[i].used;
  result.corners = std::move(final_errors);
  result.rms_px = rms(result.corners);
  const BundleSigmas spread = sigmas(bundle, used, board, result.rms_px / std::sqrt(2.0));
  result.focal_sigma = spread.left_focal_px / bundle.left.fx_px;
  result.baseline_sigma_m = spread.baseline_m;
  result.calibration.left = bundle.left;
  result.calibration.right = bundle.right;
  result.calibration.right_from_left = bundle.right_from_left;
  result.calibration.dialect = "opencv";
  result.left_from_board = std::move(bundle.left_from_board);
  report(1);
  return result;
}

}  // namespace flogmap
