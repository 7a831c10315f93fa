// From a captured pair to a pose and, now and then, a view for the map: the vision half of the program.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/rectifier.hpp"
#include "camera/stereo_frame.hpp"
#include "mapping/flog/view_selector.hpp"
#include "mapping/given_poses.hpp"
#include "mapping/odometry/level_start.hpp"
#include "mapping/odometry/stereo_odometry.hpp"
#include "mapping/stereo/disparity_matcher.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// How the world is levelled when no first pose is given.
enum class AlignMode : std::uint8_t {
  automatic,  // gravity where a sensor tells it, else the ground, else none
  none,       // the first camera counts as level and stands at z = 0
  gravity,    // needs a sensor
  ground,     // by the dominant plane of the first seconds, whatever a sensor says
};

struct FrontEndOptions {
  StereoOptions stereo;
  OdometryOptions odometry;
  ViewSelectorOptions views;
  AlignMode align = AlignMode::automatic;
  LevelOptions level;
  std::optional<SE3> first_world_from_camera;  // rectified left camera; nothing = level_start decides
};

/// How long each stage took, milliseconds.
struct StageTimes {
  double rectify_ms = 0;
  double disparity_ms = 0;
  double odometry_ms = 0;
};

struct FrontEndResult {
  Tracking tracking;
  std::shared_ptr<const RectifiedFrame> rectified;
  std::shared_ptr<const DisparityImage> disparity;
  std::optional<SE3> world_from_camera;  // of this frame, once the start is decided and if it has a pose
  std::vector<TrajectoryEntry> path;     // poses known since the last frame: usually one; all of the first
                                         // seconds at once when the start is decided
  std::vector<View> views;               // likewise, of those that moved or turned enough
  std::optional<double> row_offset_px;   // right rows lie so much lower than left ones; see RowWatch
  StageTimes times;
};

/// rectify -> match -> filter -> track -> select. Knows neither threads nor the network. Pure: the same
/// frames give the same results.
class FrontEnd {
 public:
  /// `poses`: map with these instead of odometry. `up_in_camera`: unit vector against gravity in the
  /// rectified left camera of the first frame, if a sensor says so. Throws std::runtime_error if
  /// AlignMode::gravity lacks it.
  FrontEnd(const FrontEndOptions& options, Rectifier rectifier, std::optional<GivenPoses> poses,
           std::optional<Eigen::Vector3d> up_in_camera);
  ~FrontEnd();
  FrontEnd(FrontEnd&&) noexcept;
  FrontEnd& operator=(FrontEnd&&) noexcept;

  FrontEndResult process(const StereoFrame& frame);

  /// The source has ended. If it is still undecided which way is up, it is decided by what was seen: `path`
  /// and `views` of the answer hold the frames that waited for it.
  FrontEndResult finish();

  /// Forgets the path; the next frame is a first frame again.
  void reset();

  /// Continues in a stored map: the next frame is taken to stand where the camera stood last.
  void continue_from(const SE3& world_from_camera);

  [[nodiscard]] const StereoCamera& camera() const;
  [[nodiscard]] double max_disparity_px() const;

  /// What the heights rest on, in words; "undecided" during the first seconds.
  [[nodiscard]] std::string alignment() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flogmap
