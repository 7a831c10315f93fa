#include "mapping/odometry/placement.hpp"

#include <algorithm>
#include <utility>

#include "mapping/odometry/lost_reasons.hpp"

namespace flogmap {
namespace {

constexpr int kMaxRounds = 3;       // of finding landmarks and solving for the pose again
constexpr double kJustAlike = 0.3;  // mean difference of two patches of the same thing, see there
constexpr double kNearestZ_m = 0.05;
constexpr double kSamePose_px = 1;      // poses solved from two key frames' hypotheses agree that well
constexpr double kBehind_px = 1000;     // as far as a landmark behind the camera counts
constexpr std::int64_t kLastPose = -1;  // a hypothesis of no key frame

class Placing {
 public:
  Placing(const StereoCamera& camera, const LocalMap& map, const RectifiedFrame& frame,
          const FrameFeatures& features, const PlacementOptions& options)
      : camera_(camera), map_(map), frame_(frame), features_(features), options_(options) {}

  /// True once a convincing placement is found.
  bool try_key_frame(const KeyFrame& key, PatchFrame patches) {
    const auto match = match_frames(camera_, key.matchable(), {frame_.left, features_}, patches,
                                    options_.matching, options_.consistency);
    note(match, patches, key);
    bool convinced = false;
    for (const auto& current_from_key : {match.current_from_key, match.rival}) {  // both: the better one wins
      if (!current_from_key) continue;
      convinced = try_pose(key.odometry_from_camera * current_from_key->inverse(), key.id) || convinced;
    }
    return convinced;
  }

  /// `source` tells hypotheses apart that are independent of one another: the key frame's id.
  bool try_pose(SE3 odometry_from_camera, std::int64_t source) {
    int last_inliers = 0;
    for (int round = 0; round < kMaxRounds; ++round) {
      auto placement = test(odometry_from_camera);
      if (!placement) return false;
      odometry_from_camera = placement->odometry_from_camera;
      const bool confirmed = confirmed_by(odometry_from_camera, source);
      const int num_inliers = placement->num_inliers;
      keep_if_better(*std::move(placement), source);
      if (confirmed || convincing()) return true;
      if (num_inliers <= last_inliers) return false;
      last_inliers = num_inliers;
    }
    return false;
  }

  PlacementResult result() && {
    const bool many = best_.num_inliers >= options_.min_inliers;
    const bool certain =
        best_.sigma_m() <= options_.max_sigma_m && best_.sigma_rad() <= options_.max_sigma_rad;
    if (many && certain) return {std::move(best_), ""};
    if (many) return {std::nullopt, kFixedBadly};
    if (seen_.most_agreeing >= options_.matching.min_consistent && best_.num_inliers > 0) {
      return {std::nullopt,
              counted("too few landmarks found again", best_.num_inliers, options_.min_inliers)};
    }
    return {std::nullopt, why_no_motion(seen_, options_.matching.min_consistent)};
  }

 private:
  /// Not where one landmark decided: if it was a wrong one, the landmarks that would say so lay out of reach
  /// of the search, which goes on from the pose without it.
  [[nodiscard]] bool convincing() const {
    if (best_.one_decided) return false;
    return best_.num_inliers >= options_.many_inliers ||
           (best_.num_inliers >= options_.convincing_inliers && best_.share() >= options_.convincing_share);
  }

  /// Two key frames that lead to the same pose are right: what moved by itself between them would lead to
  /// two. Hypotheses alone say little: one that turns too much and shifts too little may lie a few pixels
  /// off.
  [[nodiscard]] bool confirmed_by(const SE3& odometry_from_camera, std::int64_t source) const {
    return source != best_source_ && best_.num_inliers >= options_.convincing_inliers &&
           distance_px(odometry_from_camera, best_) <= kSamePose_px;
  }

  /// For the reason, should there be no pose.
  void note(const FrameMatch& match, PatchFrame patches, const KeyFrame& key) {
    seen_.most_agreeing = std::max(seen_.most_agreeing, static_cast<int>(match.consistent.size()));
    if (patches != PatchFrame::upright || match.current_from_key) return;
    const auto just_alike = [&](const IndexPair& pair) {
      return mean_difference(key.features.upright[pair.key], features_.upright[pair.current]) < kJustAlike;
    };
    const auto count = std::count_if(match.pairs.begin(), match.pairs.end(), just_alike);
    seen_.most_alike = std::max(seen_.most_alike, static_cast<int>(count));
  }

  void keep_if_better(Placement placement, std::int64_t source) {
    if (placement.num_inliers <= best_.num_inliers) return;
    best_ = std::move(placement);
    best_source_ = source;
  }

  /// How far from where they are seen a pose puts a placement's inliers, on average.
  [[nodiscard]] double distance_px(const SE3& odometry_from_camera, const Placement& placement) const {
    const SE3 camera_from_odometry = odometry_from_camera.inverse();
    double sum_px = 0;
    for (std::size_t i = 0; i < placement.sightings.size(); ++i) {
      if (!placement.inlier[i]) continue;
      const Sighting& s = placement.sightings[i];
      const Eigen::Vector3d p = camera_from_odometry * map_.landmark(s.landmark).in_odometry;
      sum_px += p.z() > kNearestZ_m ? (project(camera_, p) - s.pixel).norm() : kBehind_px;
    }
    return sum_px / std::max(placement.num_inliers, 1);
  }

  /// Landmarks near a hypothesis, and the pose that they ask for.
  [[nodiscard]] std::optional<Placement> test(const SE3& odometry_from_camera) const {
    auto found = map_.find(frame_, odometry_from_camera, options_.search_radius_px);
    std::vector<MotionPoint> points;
    for (const Sighting& s : found.sightings) {
      const Landmark& landmark = map_.landmark(s.landmark);
      points.push_back({landmark.in_odometry, landmark.covariance, s.pixel, s.view_change});
    }
    auto motion = refine_motion(camera_, points, odometry_from_camera.inverse(), options_.motion);
    if (!motion) return std::nullopt;
    return Placement{.odometry_from_camera = motion->current_from_key.inverse(),
                     .covariance = motion->covariance,
                     .sightings = std::move(found.sightings),
                     .inlier = std::move(motion->inlier),
                     .num_inliers = motion->num_inliers,
                     .one_decided = motion->with_decisive.has_value(),
                     .missed = std::move(found.missed)};
  }

  const StereoCamera& camera_;
  const LocalMap& map_;
  const RectifiedFrame& frame_;
  const FrameFeatures& features_;
  const PlacementOptions& options_;
  Placement best_;
  std::int64_t best_source_ = kLastPose;
  SeenAgain seen_;
};

}  // namespace

PlacementResult place(const StereoCamera& camera, const LocalMap& map, const RectifiedFrame& frame,
                      const FrameFeatures& features, const std::vector<const KeyFrame*>& known,
                      const SE3& last_odometry_from_camera, const PlacementOptions& options) {
  Placing placing(camera, map, frame, features, options);
  for (const PatchFrame patches : {PatchFrame::upright, PatchFrame::own_orientation}) {
    for (const KeyFrame* key : known) {
      if (placing.try_key_frame(*key, patches)) return std::move(placing).result();
    }
  }
  placing.try_pose(last_odometry_from_camera, kLastPose);
  return std::move(placing).result();
}

}  // namespace flogmap
