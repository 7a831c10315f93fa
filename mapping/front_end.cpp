#include "mapping/front_end.hpp"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "mapping/stereo/row_offset.hpp"
#include "mapping/stereo/segment_filter.hpp"

namespace flogmap {
namespace {

/// Time since the last lap, milliseconds.
class LapTimer {
 public:
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

struct FrontEnd::Parts {
  /// A tracked frame of the first seconds, before it is known which way is up.
  struct Waiting {
    TrajectoryEntry entry;  // its pose still in the odometry's own frame
    std::optional<View> view;
  };

  Parts(const FrontEndOptions& given_options, Rectifier given_rectifier,
        std::optional<GivenPoses> given_poses, std::optional<Eigen::Vector3d> up)
      : options(given_options),
        rectifier(std::move(given_rectifier)),
        matcher(make_matcher(options.stereo, rectifier.camera())),
        rows(options.stereo.min_disparity, num_disparities()),
        odometry(options.odometry, rectifier.camera()),
        selector(options.views, rectifier.camera()),
        poses(std::move(given_poses)),
        up_in_camera(std::move(up)) {
    if (options.align == AlignMode::gravity && !up_in_camera) {
      throw std::runtime_error(
          "--align gravity: the source has no inertial sensor; allowed: auto|none|ground");
    }
    start_anew();
  }

  void start_anew() {
    rows.reset();
    odometry.reset();
    selector.reset();
    waiting.clear();
    segment = 0;
    world_from_odometry.reset();
    alignment = "undecided";
    if (poses) {
      begin_at(SE3::Identity(), "given poses");
    } else if (options.first_world_from_camera) {
      begin_at(*options.first_world_from_camera, "given first pose");
    } else if (options.align == AlignMode::none) {
      begin_at(level_of_camera(), "none: the first camera counts as level and stands at z = 0");
    } else {
      level_start.emplace(rectifier.camera(), options.level,
                          options.align == AlignMode::ground ? std::nullopt : up_in_camera);
    }
  }

  void begin_at(const SE3& world_from_first, const std::string& how) {
    world_from_odometry = world_from_first;
    alignment = how;
  }

  [[nodiscard]] int num_disparities() const {
    const StereoOptions& stereo = options.stereo;
    if (stereo.num_disparities > 0) return stereo.num_disparities;
    return auto_num_disparities(rectifier.camera(), stereo.nearest_m, stereo.min_disparity);
  }

  Tracking track(const FrontEndResult& result);
  void place(FrontEndResult& result);
  void deliver(FrontEndResult& result);

  FrontEndOptions options;
  Rectifier rectifier;
  std::unique_ptr<DisparityMatcher> matcher;
  RowWatch rows;
  StereoOdometry odometry;
  ViewSelector selector;
  int segment = 0;  // of the last frame with a pose
  std::optional<GivenPoses> poses;
  std::optional<Eigen::Vector3d> up_in_camera;
  std::optional<LevelStart> level_start;
  std::optional<SE3> world_from_odometry;
  std::string alignment;
  std::vector<Waiting> waiting;
};

FrontEnd::FrontEnd(const FrontEndOptions& options, Rectifier rectifier, std::optional<GivenPoses> poses,
                   std::optional<Eigen::Vector3d> up_in_camera)
    : parts_(std::make_unique<Parts>(options, std::move(rectifier), std::move(poses),
                                     std::move(up_in_camera))) {}
FrontEnd::~FrontEnd() = default;
FrontEnd::FrontEnd(FrontEnd&&) noexcept = default;
FrontEnd& FrontEnd::operator=(FrontEnd&&) noexcept = default;

FrontEndResult FrontEnd::process(const StereoFrame& frame) {
  Parts& p = *parts_;
  FrontEndResult result;
  LapTimer timer;
  result.rectified = std::make_shared<RectifiedFrame>(p.rectifier.rectify(frame));
  result.times.rectify_ms = timer.lap_ms();
  result.row_offset_px = p.rows.add(*result.rectified);
  DisparityImage disparity = p.matcher->match(*result.rectified);
  remove_small_segments(disparity, min_segment_px(p.options.stereo, p.rectifier.camera()));
  result.disparity = std::make_shared<DisparityImage>(std::move(disparity));
  result.times.disparity_ms = timer.lap_ms();
  result.tracking = p.track(result);
  if (result.tracking.has_pose()) p.place(result);
  result.times.odometry_ms = timer.lap_ms();
  return result;
}

/// Where the camera is in the odometry's own frame: estimated, or looked up.
Tracking FrontEnd::Parts::track(const FrontEndResult& result) {
  if (!poses) return odometry.track(*result.rectified, *result.disparity);
  Tracking tracking;
  const std::optional<SE3> pose = poses->at(result.rectified->timestamp_ns);
  tracking.state = pose ? TrackingState::ok : TrackingState::lost;
  if (pose) tracking.odometry_from_camera = *pose;
  if (!pose) tracking.reason = "no pose is given within 5 ms of this frame";
  return tracking;
}

/// Puts the frame into the world, as a place of the path and, if it shows something new, as a view. Until it
/// is decided which way is up, frames wait.
void FrontEnd::Parts::place(FrontEndResult& result) {
  const Tracking& tracking = result.tracking;
  const std::int64_t timestamp_ns = result.rectified->timestamp_ns;
  if (std::exchange(segment, tracking.segment) != tracking.segment) selector.reset();
  // A weak pose is shown but not mapped.
  const bool mapped = tracking.state == TrackingState::ok && selector.accept(tracking.odometry_from_camera);
  Waiting frame{{timestamp_ns, tracking.odometry_from_camera, tracking.state, mapped, tracking.segment},
                std::nullopt};
  if (mapped) {
    frame.view = View{timestamp_ns, tracking.odometry_from_camera, *result.disparity, result.rectified->left,
                      tracking.segment};
  }
  waiting.push_back(std::move(frame));
  if (!world_from_odometry) {
    const std::optional<Level> level =
        level_start->add(timestamp_ns, *result.disparity, tracking.odometry_from_camera);
    if (!level) return;
    begin_at(level->world_from_odometry, level->how);
  }
  result.world_from_camera = *world_from_odometry * tracking.odometry_from_camera;
  deliver(result);
}

/// Frames that waited for the world get their place in it.
void FrontEnd::Parts::deliver(FrontEndResult& result) {
  for (Waiting& known : waiting) {
    known.entry.world_from_camera = *world_from_odometry * known.entry.world_from_camera;
    result.path.push_back(known.entry);
    if (!known.view) continue;
    known.view->world_from_camera = *world_from_odometry * known.view->world_from_camera;
    result.views.push_back(std::move(*known.view));
  }
  waiting.clear();
}

FrontEndResult FrontEnd::finish() {
  Parts& p = *parts_;
  FrontEndResult result;
  if (p.waiting.empty()) return result;
  const Level level = p.level_start->decide_now();
  p.begin_at(level.world_from_odometry, level.how);
  p.deliver(result);
  return result;
}

void FrontEnd::reset() { parts_->start_anew(); }

void FrontEnd::continue_from(const SE3& world_from_camera) {
  parts_->start_anew();
  parts_->begin_at(world_from_camera, "continued where the stored map ended");
}

const StereoCamera& FrontEnd::camera() const { return parts_->rectifier.camera(); }

double FrontEnd::max_disparity_px() const {
  return parts_->options.stereo.min_disparity + parts_->num_disparities() - 1;
}

std::string FrontEnd::alignment() const { return parts_->alignment; }

}  // namespace flogmap
