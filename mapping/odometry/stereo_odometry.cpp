#include "mapping/odometry/stereo_odometry.hpp"

#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "mapping/odometry/local_map.hpp"
#include "mapping/odometry/lost_reasons.hpp"

namespace flogmap {
namespace {

void require(bool fine, const std::string& what) {
  if (!fine) throw std::runtime_error("odometry: " + what);
}

void check(const OdometryOptions& options, const StereoCamera& camera) {
  require(camera.focal_px > 0, "focal_px must be > 0, got " + std::to_string(camera.focal_px));
  require(camera.baseline_m > 0, "baseline_m must be > 0, got " + std::to_string(camera.baseline_m));
  const int min_inliers = options.placement.min_inliers;
  require(min_inliers >= 4, "min_inliers must be >= 4, got " + std::to_string(min_inliers));
  require(options.max_key_frames >= 1,
          "max_key_frames must be >= 1, got " + std::to_string(options.max_key_frames));
  require(options.key_frame_overlap > 0 && options.key_frame_overlap < 1,
          "key_frame_overlap must lie between 0 and 1, got " + std::to_string(options.key_frame_overlap));
}

/// What is known of the current frame before it has a pose.
struct Current {
  const RectifiedFrame& frame;
  const DisparityImage& disparity;
  FrameFeatures features;
};

constexpr int kKeyFramesToTry = 3;       // while not lost
constexpr std::int64_t kLastFrame = -2;  // its number, as key frames have theirs

}  // namespace

class StereoOdometry::Tracker {
 public:
  Tracker(const OdometryOptions& options, const StereoCamera& camera)
      : options_(options),
        camera_(camera),
        map_(camera, options.max_key_frames, options.max_landmarks,
             options.placement.motion.disparity_sigma_px) {}

  Tracking track(const RectifiedFrame& frame, const DisparityImage& disparity) {
    Tracking tracking = track_frame(frame, disparity);
    tracking.segment = segment_;
    return tracking;
  }

  void reset() {
    map_.clear();
    last_.reset();
    pose_ = SE3::Identity();
    num_lost_ = 0;
    segment_ = 0;
  }

 private:
  Tracking track_frame(const RectifiedFrame& frame, const DisparityImage& disparity) {
    Current current{frame, disparity, extract_features(camera_, frame.left, disparity, options_.corners)};
    Tracking tracking;
    for (const Corner& corner : current.features.corners) tracking.corners_px.push_back(corner.px);
    const bool first = map_.key_frames().empty();
    if (static_cast<int>(current.features.corners.size()) < options_.min_corners ||
        (first && hardly_any_disparity(current.features))) {
      return without_pose(std::move(tracking),
                          why_too_few_corners(frame.left, current.features, options_.min_corners, !first));
    }
    if (first) return start(std::move(tracking), current, "");
    auto [placement, reason] =
        place(camera_, map_, frame, current.features, known_frames(), pose_, options_.placement);
    if (placement) return with_pose(std::move(tracking), current, *placement);
    if (++num_lost_ <= options_.max_lost_frames) return without_pose(std::move(tracking), std::move(reason));
    return start_segment(std::move(tracking), current, reason);
  }

  /// What a frame is compared with: the newest key frame, the last frame that has a pose, older key frames.
  [[nodiscard]] std::vector<const KeyFrame*> known_frames() const {
    const int most = num_lost_ == 0 ? kKeyFramesToTry : options_.max_key_frames;
    std::vector<const KeyFrame*> known;
    for (auto key = map_.key_frames().rbegin(); key != map_.key_frames().rend(); ++key) {
      if (static_cast<int>(known.size()) >= most + (last_ ? 1 : 0)) break;
      known.push_back(&*key);
      if (known.size() == 1 && last_) known.push_back(&*last_);
    }
    return known;
  }

  Tracking without_pose(Tracking tracking, std::string reason) const {
    tracking.state = map_.key_frames().empty() ? TrackingState::initialising : TrackingState::lost;
    tracking.reason = std::move(reason);
    return tracking;
  }

  /// Makes the current frame a key frame at the last known pose.
  Tracking start(Tracking tracking, Current& current, std::string reason) {
    tracking.state = reason.empty() ? TrackingState::ok : TrackingState::weak;
    tracking.reason = std::move(reason);
    tracking.odometry_from_camera = pose_;
    tracking.new_key_frame = true;
    map_.add_key_frame(current.frame, current.disparity, std::move(current.features), pose_, {});
    num_lost_ = 0;
    return tracking;
  }

  Tracking start_segment(Tracking tracking, Current& current, const std::string& reason) {
    map_.clear();
    last_.reset();
    ++segment_;
    return start(std::move(tracking), current,
                 "not found again (" + reason + "): goes on from the last known pose");
  }

  /// Why a pose is weak; empty if it is not.
  [[nodiscard]] std::string weakness(const Placement& placed) const {
    if (placed.num_inliers < options_.weak_inliers) {
      return counted("few landmarks found again", placed.num_inliers, options_.weak_inliers);
    }
    const bool certain = placed.sigma_m() <= options_.weak_sigma_m;
    return certain ? "" : kFixedBadly;
  }

  Tracking with_pose(Tracking tracking, Current& current, const Placement& placed) {
    num_lost_ = 0;
    pose_ = placed.odometry_from_camera;
    const int num_inliers = placed.num_inliers;
    tracking.reason = weakness(placed);
    tracking.state = tracking.reason.empty() ? TrackingState::ok : TrackingState::weak;
    tracking.odometry_from_camera = pose_;
    tracking.covariance = placed.covariance;
    tracking.matches = matches_of(placed);
    tracking.new_key_frame = num_inliers < options_.key_frame_overlap *
                                               static_cast<double>(map_.key_frames().back().sightings.size());
    note(placed);
    if (!tracking.new_key_frame) {
      last_ = KeyFrame{.id = kLastFrame,
                       .odometry_from_camera = pose_,
                       .left = current.frame.left,
                       .features = std::move(current.features),
                       .sightings = {}};
    } else {
      last_.reset();
      map_.add_key_frame(current.frame, current.disparity, std::move(current.features), pose_,
                         inliers_of(placed));
    }
    return tracking;
  }

  /// The landmarks that the newest key frame sees, too.
  [[nodiscard]] std::vector<Match> matches_of(const Placement& placed) const {
    std::map<std::int64_t, Eigen::Vector2f> key_px;
    for (const Sighting& s : map_.key_frames().back().sightings)
      key_px[s.landmark] = s.pixel.head<2>().cast<float>();
    std::vector<Match> matches;
    for (std::size_t i = 0; i < placed.sightings.size(); ++i) {
      const Sighting& s = placed.sightings[i];
      const auto key = key_px.find(s.landmark);
      if (key == key_px.end()) continue;
      matches.push_back(
          {key->second, s.pixel.head<2>().cast<float>(), static_cast<float>(s.pixel.z()), placed.inlier[i]});
    }
    return matches;
  }

  void note(const Placement& placed) {
    std::vector<std::int64_t> found, missed = placed.missed;
    for (std::size_t i = 0; i < placed.sightings.size(); ++i) {
      (placed.inlier[i] ? found : missed).push_back(placed.sightings[i].landmark);
    }
    map_.note(found, missed);
  }

  [[nodiscard]] static std::vector<Sighting> inliers_of(const Placement& placed) {
    std::vector<Sighting> inliers;
    for (std::size_t i = 0; i < placed.sightings.size(); ++i) {
      if (placed.inlier[i]) inliers.push_back(placed.sightings[i]);
    }
    return inliers;
  }

  OdometryOptions options_;
  StereoCamera camera_;
  LocalMap map_;
  std::optional<KeyFrame> last_;  // frame with a pose, unless it is the newest key frame; sightings left out
  SE3 pose_ = SE3::Identity();    // the last known
  int segment_ = 0;               // see Tracking::segment
  int num_lost_ = 0;              // frames with corners but no pose, in a row
};

StereoOdometry::StereoOdometry(const OdometryOptions& options, const StereoCamera& camera) {
  check(options, camera);
  tracker_ = std::make_unique<Tracker>(options, camera);
}

StereoOdometry::~StereoOdometry() = default;
StereoOdometry::StereoOdometry(StereoOdometry&&) noexcept = default;
StereoOdometry& StereoOdometry::operator=(StereoOdometry&&) noexcept = default;

Tracking StereoOdometry::track(const RectifiedFrame& frame, const DisparityImage& disparity) {
  return tracker_->track(frame, disparity);
}

void StereoOdometry::reset() { tracker_->reset(); }

}  // namespace flogmap
