// Has this view been here before? Then all poses are corrected. HOUSE rule: odometry is never told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapping/loop/path_correction.hpp"
#include "mapping/loop/place_index.hpp"
#include "mapping/loop/pose_graph.hpp"
#include "mapping/loop/segments.hpp"
#include "mapping/odometry/frame_features.hpp"
#include "mapping/odometry/frame_matching.hpp"
#include "mapping/odometry/motion_solver.hpp"
#include "mapping/view.hpp"

namespace flogmap {

struct LoopOptions {
  CornerOptions corners{.max_corners = 400};
  MatchingOptions matching{.min_consistent = 15};
  ConsistencyOptions consistency{.image_sigma_px = 0.4, .max_turn_rad = std::nullopt};
  MotionOptions motion{.image_sigma_px = 0.5, .disparity_sigma_px = 0.3};
  PoseGraphOptions graph;
  int min_views_apart = 12;   // nearer views overlap anyway
  int min_votes = 15;         // of the place index
  int max_candidates = 3;     // that are looked at closely
  int min_inliers = 25;       // two views in a row that agree,
  int many_inliers = 60;      // or one with that many
  double max_sigma_m = 0.05;  // of the measured motion
  double drift_share = 0.03;  // odometry is off by at most this share of the path, and
  double drift_m = 0.15;      // this much: a loop that says more is false
  double drift_rad_per_m = 0.02;
  double speed_m_s = 1.5;        // and while it was lost, the camera may have moved as fast as this
  double least_change_m = 0.01;  // smaller corrections are kept for the next loop: no map is rebuilt for them
  double least_turn_rad = 0.003;
  int max_views = 4000;  // that are remembered; then the older half stays where it is and is forgotten
};

/// What a closed loop says of the path.
struct LoopCorrection {
  PathCorrection path;            // of all views so far, and so of the frames between and after them
  std::int64_t timestamp_ns = 0;  // of the newest view,
  std::int64_t met_again_ns = 0;  // and of the one that it meets again
  int num_inliers = 0;
};

/// Takes mapped views in order. Deterministic; no thread, no clock. It never sees other stages' data.
class LoopCloser {
 public:
  LoopCloser(const LoopOptions& options, const StereoCamera& camera);

  /// `view.world_from_camera` as odometry (and the level start) have it, uncorrected. `segment` changes when
  /// odometry went on after a loss without knowing where: a segment of its own, without a place until one of
  /// its views meets a view of known place. A correction if this view closes a loop that moves any view by
  /// `least_change_m` or more or gives a segment its place, else nothing.
  [[nodiscard]] std::optional<LoopCorrection> add(const View& view);

  /// Closed so far, those that moved hardly anything included.
  [[nodiscard]] int num_loops() const { return num_loops_; }

  /// Steps of odometry and, where `may_be_wrong`, loops, between views as they are remembered.
  [[nodiscard]] const std::vector<PoseEdge>& edges() const { return edges_; }

 private:
  struct Remembered {
    std::int64_t timestamp_ns = 0;
    int segment = 0;
    SE3 world_from_camera;                // uncorrected
    double path_m = 0;                    // walked until here
    std::vector<Eigen::Vector3d> points;  // corners, metres, camera frame
    std::vector<Descriptor> patches;      // what they look like, in their own orientation and size
  };
  struct Meeting {
    int view = 0, earlier_view = 0;
    SE3 earlier_from_view;
    Covariance6 covariance;
    int num_inliers = 0;
  };

  void remember(const View& view);
  void add_odometry_edge();
  [[nodiscard]] std::optional<Meeting> meet(int earlier_view) const;
  [[nodiscard]] bool plausible(const Meeting& meeting) const;
  [[nodiscard]] bool confirmed(const Meeting& meeting) const;
  [[nodiscard]] SE3 implied_correction(const Meeting& meeting) const;
  [[nodiscard]] std::optional<LoopCorrection> close(const Meeting& meeting);
  [[nodiscard]] std::vector<SE3> joined(const Meeting& meeting) const;
  [[nodiscard]] bool agrees(const Meeting& meeting) const;
  [[nodiscard]] int num_old_views() const;
  [[nodiscard]] LoopCorrection correction(const Meeting& meeting) const;
  void forget_older_half();

  LoopOptions options_;
  StereoCamera camera_;
  PlaceIndex index_;
  std::vector<Remembered> views_;
  std::vector<SE3> corrected_;  // world_from_camera
  std::vector<PoseEdge> edges_;
  Segments segments_;
  std::vector<CorrectionKnot> forgotten_;  // where views were put that are remembered no more
  std::optional<Meeting> pending_;         // waits for a second view that says the same
  int num_loops_ = 0;
};

}  // namespace flogmap
