// The last key frames and the landmarks that they saw.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "mapping/odometry/key_frame.hpp"
#include "mapping/odometry/landmark.hpp"

namespace flogmap {

/// What came of looking for landmarks.
struct FoundLandmarks {
  std::vector<Sighting> sightings;
  std::vector<std::int64_t> missed;  // that the picture should show, but does not
};

class LocalMap {
 public:
  LocalMap(const StereoCamera& camera, int max_key_frames, int max_landmarks, double disparity_sigma_px)
      : camera_(camera),
        max_key_frames_(max_key_frames),
        max_landmarks_(max_landmarks),
        disparity_sigma_px_(disparity_sigma_px) {}

  /// Takes a frame in. `sightings`: the landmarks that it sees, which are placed anew with what it says of
  /// them; new ones are made at its other corners.
  void add_key_frame(const RectifiedFrame& frame, const DisparityImage& disparity, FrameFeatures features,
                     const SE3& odometry_from_camera, std::vector<Sighting> sightings);

  /// Oldest first.
  [[nodiscard]] const std::deque<KeyFrame>& key_frames() const { return key_frames_; }
  [[nodiscard]] const Landmark& landmark(std::int64_t id) const { return landmarks_.at(id); }

  /// Looks for the landmarks, those of the newest key frame first, until max_landmarks are found.
  [[nodiscard]] FoundLandmarks find(const RectifiedFrame& frame, const SE3& odometry_from_camera,
                                    double radius_px) const;

  /// Notes which landmarks were found and which were missed by a frame, and forgets those that are missed
  /// more often than found: hidden ones, and those at a wrong place.
  void note(const std::vector<std::int64_t>& found, const std::vector<std::int64_t>& missed);

  void clear();

 private:
  void add_landmarks(const RectifiedFrame& frame, const DisparityImage& disparity, KeyFrame& key_frame);
  void add_sighting(const Sighting& sighting, const KeyFrame& key_frame);
  void forget_oldest();

  StereoCamera camera_;
  int max_key_frames_;
  int max_landmarks_;
  double disparity_sigma_px_;
  std::deque<KeyFrame> key_frames_;
  std::map<std::int64_t, Landmark> landmarks_;
  std::int64_t next_key_frame_ = 0;
  std::int64_t next_landmark_ = 0;
};

}  // namespace flogmap
