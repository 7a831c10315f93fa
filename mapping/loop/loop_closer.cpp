#include "mapping/loop/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mapping/triangulate.hpp"

namespace flogmap {
namespace {

constexpr int kConfirmWithinViews = 5;
constexpr double kSamePlaceMetres = 0.1;  // two meetings say the same if their corrections differ less
constexpr double kSameTurnRadians = 0.035;

double angle_of(const SE3& motion) { return Eigen::AngleAxisd(motion.linear()).angle(); }

/// Patches are compared at the size that they have at this distance: as far away as ten baselines.
float disparity_of_scale_1(const StereoCamera& camera) { return static_cast<float>(camera.focal_px / 20); }

/// Odometry's step as uncertain as experience says: a share of the way, a share of the turn, and a floor.
Covariance6 step_covariance(const SE3& step, bool after_loss) {
  const double metres = after_loss ? 1 : 0.002 + 0.005 * step.translation().norm();
  const double radians = after_loss ? 1 : 0.0005 + 0.002 * (step.translation().norm() + angle_of(step));
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << metres, metres, metres, radians, radians, radians;
  return sigma.cwiseAbs2().asDiagonal();
}

/// The same corner seen from elsewhere is not quite the same point: more matches do not make this smaller.
Covariance6 with_floor(Covariance6 covariance) {
  constexpr double kMetres = 0.008, kRadians = 0.003;
  covariance.diagonal().head<3>().array() += kMetres * kMetres;
  covariance.diagonal().tail<3>().array() += kRadians * kRadians;
  return covariance;
}

double largest_move_m(const std::vector<SE3>& before, const std::vector<SE3>& after) {
  double largest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    largest = std::max(largest, (after[i].translation() - before[i].translation()).norm());
  }
  return largest;
}

}  // namespace

LoopCloser::LoopCloser(const LoopOptions& options, const StereoCamera& camera)
    : options_(options), camera_(camera) {}

void LoopCloser::remember(const View& view) {
  FrameFeatures features = extract_features(camera_, view.left, view.disparity, options_.corners);
  const auto scales = scales_by_nearness(features, disparity_of_scale_1(camera_));
  Remembered now{.timestamp_ns = view.timestamp_ns,
                 .segment = view.segment,
                 .world_from_camera = view.world_from_camera,
                 .path_m = 0,
                 .points = std::move(features.points),
                 .patches = describe(view.left, features.corners, PatchFrame::own_orientation, scales)};
  SE3 corrected = view.world_from_camera;
  if (!views_.empty()) {
    const Remembered& last = views_.back();
    const SE3 step = last.world_from_camera.inverse() * now.world_from_camera;
    now.path_m = last.path_m + step.translation().norm();
    corrected = corrected_.back() * step;
  }
  views_.push_back(std::move(now));
  corrected_.push_back(corrected);
}

void LoopCloser::add_odometry_edge() {
  const int to = static_cast<int>(views_.size()) - 1;
  if (to == 0) return;
  const Remembered &a = views_[to - 1], &b = views_[to];
  const SE3 step = a.world_from_camera.inverse() * b.world_from_camera;
  edges_.push_back({to - 1, to, step, step_covariance(step, a.segment != b.segment), false});
}

/// Views that may be met again: not the last few, which overlap anyway, unless they are of another segment.
int LoopCloser::num_old_views() const {
  const int segment = views_.back().segment;
  const auto first = std::find_if(views_.begin(), views_.end(),
                                  [=](const Remembered& view) { return view.segment == segment; });
  return std::max(static_cast<int>(first - views_.begin()),
                  static_cast<int>(views_.size()) - 1 - options_.min_views_apart);
}

std::optional<LoopCorrection> LoopCloser::add(const View& view) {
  if (static_cast<int>(views_.size()) >= options_.max_views) forget_older_half();
  remember(view);
  add_odometry_edge();
  std::vector<BinaryPatch> patches;
  for (const Descriptor& descriptor : views_.back().patches) patches.push_back(binary_patch(descriptor));
  std::optional<Meeting> best;
  for (const PlaceCandidate& c : index_.query(patches, num_old_views(), options_.max_candidates)) {
    if (c.votes < options_.min_votes) break;
    const auto meeting = meet(c.view);
    if (meeting && plausible(*meeting) && (!best || meeting->num_inliers > best->num_inliers)) best = meeting;
  }
  index_.add(patches);
  if (!best) return std::nullopt;
  if (best->num_inliers >= options_.many_inliers || confirmed(*best)) return close(*best);
  pending_ = best;
  return std::nullopt;
}

/// The same test as between frames: a consistent set of matches under any motion, then all matches that fit
/// it.
std::optional<LoopCloser::Meeting> LoopCloser::meet(int earlier_view) const {
  const Remembered &earlier = views_[earlier_view], &now = views_.back();
  const auto match =
      match_points(camera_, now.points, earlier.points,
                   match_mutually(now.patches, earlier.patches, options_.matching.max_difference),
                   options_.matching.min_consistent, options_.consistency);
  if (!match.current_from_key) return std::nullopt;
  std::vector<MotionPoint> points;
  for (const IndexPair& pair : match.pairs) {
    const Eigen::Vector3d& p = now.points[pair.key];
    points.push_back({p, point_covariance(camera_, p, options_.motion.image_sigma_px),
                      project(camera_, earlier.points[pair.current])});
  }
  const auto motion = refine_motion(camera_, points, *match.current_from_key, options_.motion);
  if (!motion || motion->num_inliers < options_.min_inliers) return std::nullopt;
  return Meeting{static_cast<int>(views_.size()) - 1, earlier_view, motion->current_from_key,
                 motion->covariance, motion->num_inliers};
}

/// The loop's own certainty, and whether odometry can have been that far off.
bool LoopCloser::plausible(const Meeting& meeting) const {
  if (meeting.covariance.diagonal().head<3>().sum() > options_.max_sigma_m * options_.max_sigma_m)
    return false;
  const Remembered &earlier = views_[meeting.earlier_view], &now = views_[meeting.view];
  const SE3 by_odometry = corrected_[meeting.earlier_view].inverse() * corrected_[meeting.view];
  const SE3 gap = meeting.earlier_from_view.inverse() * by_odometry;
  const double path_m = now.path_m - earlier.path_m;
  double metres = options_.drift_m + options_.drift_share * path_m;
  double radians = 0.1 + options_.drift_rad_per_m * path_m;
  for (int i = meeting.earlier_view + 1; i <= meeting.view; ++i) {
    if (views_[i].segment == views_[i - 1].segment) continue;
    metres +=
        options_.speed_m_s * static_cast<double>(views_[i].timestamp_ns - views_[i - 1].timestamp_ns) * 1e-9;
    radians = std::numbers::pi;
  }
  return gap.translation().norm() <= metres && angle_of(gap) <= radians;
}

/// What this meeting would do to the pose of its view, in the world.
SE3 LoopCloser::implied_correction(const Meeting& meeting) const {
  return corrected_[meeting.earlier_view] * meeting.earlier_from_view *
         views_[meeting.view].world_from_camera.inverse();
}

bool LoopCloser::confirmed(const Meeting& meeting) const {
  if (!pending_ || meeting.view - pending_->view > kConfirmWithinViews) return false;
  const Eigen::Vector3d place = views_[meeting.view].world_from_camera.translation();
  const SE3 a = implied_correction(meeting), b = implied_correction(*pending_);
  return (a * place - b * place).norm() <= kSamePlaceMetres && angle_of(a.inverse() * b) <= kSameTurnRadians;
}

/// The views stand to one another as the meeting says, as good as exactly.
bool LoopCloser::agrees(const Meeting& meeting) const {
  const SE3 gap = meeting.earlier_from_view.inverse() * corrected_[meeting.earlier_view].inverse() *
                  corrected_[meeting.view];
  return gap.translation().norm() < options_.least_change_m / 2 && angle_of(gap) < options_.least_turn_rad;
}

/// Two segments meet: the one without a place is put, as a whole, where the meeting says.
std::vector<SE3> LoopCloser::joined(const Meeting& meeting) const {
  const int segment = views_[meeting.view].segment, earlier = views_[meeting.earlier_view].segment;
  const bool newer_moves = !segments_.has_place(segment);
  const SE3 newer_by =
      corrected_[meeting.earlier_view] * meeting.earlier_from_view * corrected_[meeting.view].inverse();
  const SE3 move = newer_moves ? newer_by : newer_by.inverse();
  std::vector<SE3> poses = corrected_;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (segments_.together(views_[i].segment, newer_moves ? segment : earlier)) poses[i] = move * poses[i];
  }
  return poses;
}

std::optional<LoopCorrection> LoopCloser::close(const Meeting& meeting) {
  edges_.push_back(
      {meeting.earlier_view, meeting.view, meeting.earlier_from_view, with_floor(meeting.covariance), true});
  pending_.reset();
  ++num_loops_;
  const int segment = views_[meeting.view].segment, earlier = views_[meeting.earlier_view].segment;
  const bool joins = !segments_.together(segment, earlier);
  if (!joins && agrees(meeting)) return std::nullopt;
  auto corrected = optimise_poses(joins ? joined(meeting) : corrected_, edges_, options_.graph);
  if (!joins && largest_move_m(corrected_, corrected) < options_.least_change_m) return std::nullopt;
  if (joins) segments_.join(segment, earlier);
  corrected_ = std::move(corrected);
  return correction(meeting);
}

LoopCorrection LoopCloser::correction(const Meeting& meeting) const {
  std::vector<CorrectionKnot> knots = forgotten_;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const Remembered& view = views_[i];
    if (!segments_.has_place(view.segment)) continue;
    knots.push_back({view.timestamp_ns, view.segment, corrected_[i] * view.world_from_camera.inverse()});
  }
  return {PathCorrection(std::move(knots)), views_[meeting.view].timestamp_ns,
          views_[meeting.earlier_view].timestamp_ns, meeting.num_inliers};
}

void LoopCloser::forget_older_half() {
  const int count = static_cast<int>(views_.size()) / 2;
  for (int i = 0; i < count; ++i) {
    if (!segments_.has_place(views_[i].segment)) continue;
    forgotten_.push_back(
        {views_[i].timestamp_ns, views_[i].segment, corrected_[i] * views_[i].world_from_camera.inverse()});
  }
  views_.erase(views_.begin(), views_.begin() + count);
  corrected_.erase(corrected_.begin(), corrected_.begin() + count);
  std::erase_if(edges_, [=](const PoseEdge& edge) { return edge.from < count || edge.to < count; });
  for (PoseEdge& edge : edges_) {
    edge.from -= count;
    edge.to -= count;
  }
  index_.forget_oldest(count);
  pending_.reset();
}

}  // namespace flogmap
