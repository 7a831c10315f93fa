#include "mapping/odometry/frame_matching.hpp"

#include <algorithm>

#include "mapping/odometry/motion_solver.hpp"
#include "mapping/triangulate.hpp"

namespace flogmap {
namespace {

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The closed form knows distances only; pixels know better. Stays where it started if that fails.
void refine(const StereoCamera& camera, const std::vector<PointPair>& pairs, const SE3& start,
            double sigma_px, FrameMatch& match) {
  std::vector<MotionPoint> points;
  for (const PointPair& pair : pairs) {
    points.push_back(
        {pair.in_key, point_covariance(camera, pair.in_key, sigma_px), project(camera, pair.in_current)});
  }
  MotionOptions options;
  options.image_sigma_px = sigma_px;
  options.disparity_sigma_px = sigma_px;
  const auto motion = refine_motion(camera, points, start, options);
  match.current_from_key = motion ? motion->current_from_key : start;
  if (motion) match.rival = motion->with_decisive;
}

}  // namespace

FrameMatch match_points(const StereoCamera& camera, const std::vector<Eigen::Vector3d>& key,
                        const std::vector<Eigen::Vector3d>& current, std::vector<IndexPair> pairs,
                        int min_consistent, const ConsistencyOptions& consistency) {
  std::vector<PointPair> points;
  for (const IndexPair& pair : pairs) points.push_back({key[pair.key], current[pair.current]});
  FrameMatch match;
  match.consistent = largest_consistent_set(camera, points, consistency);
  match.pairs = std::move(pairs);
  if (static_cast<int>(match.consistent.size()) < min_consistent) return match;
  std::vector<PointPair> chosen;
  std::vector<double> weights;  // 1 / trace of the covariances
  for (const int i : match.consistent) {
    chosen.push_back(points[i]);
    weights.push_back(1 / (point_covariance(camera, points[i].in_key).trace() +
                           point_covariance(camera, points[i].in_current).trace()));
  }
  const auto start = align_points(chosen, weights);
  if (start) refine(camera, chosen, *start, consistency.image_sigma_px, match);
  return match;
}

FrameMatch match_frames(const StereoCamera& camera, const MatchableFrame& key, const MatchableFrame& current,
                        PatchFrame patches, const MatchingOptions& matching,
                        const ConsistencyOptions& consistency) {
  const FrameFeatures &from = key.features, &to = current.features;
  if (from.corners.empty() || to.corners.empty()) return {};
  if (patches == PatchFrame::upright) {
    return match_points(camera, from.points, to.points,
                        match_mutually(from.upright, to.upright, matching.max_difference),
                        matching.min_consistent, consistency);
  }
  const float d = median(from.disparity_px);
  const auto turned = [d](const MatchableFrame& frame) {
    return describe(frame.left, frame.features.corners, PatchFrame::own_orientation,
                    scales_by_nearness(frame.features, d));
  };
  ConsistencyOptions any_turn = consistency;
  any_turn.max_turn_rad.reset();
  return match_points(camera, from.points, to.points,
                      match_mutually(turned(key), turned(current), matching.max_difference),
                      matching.min_consistent, any_turn);
}

}  // namespace flogmap
