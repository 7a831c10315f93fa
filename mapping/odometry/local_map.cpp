#include "mapping/odometry/local_map.hpp"

#include <algorithm>
#include <utility>

namespace flogmap {
namespace {

constexpr int kSpacingPx = 12;  // between landmarks of one frame
constexpr int kMissesForgiven = 1;

/// Remembers which parts of a picture are taken.
class Spacing {
 public:
  Spacing(int width, int height)
      : columns_(width / kSpacingPx + 1),
        taken_(static_cast<std::size_t>(columns_) * (height / kSpacingPx + 1), false) {}

  [[nodiscard]] bool is_free(const Eigen::Vector2d& px) const { return !taken_[cell(px)]; }
  void take(const Eigen::Vector2d& px) { taken_[cell(px)] = true; }

 private:
  [[nodiscard]] std::size_t cell(const Eigen::Vector2d& px) const {
    const int column = static_cast<int>(px.x()) / kSpacingPx, row = static_cast<int>(px.y()) / kSpacingPx;
    return static_cast<std::size_t>(row) * columns_ + column;
  }

  int columns_;
  std::vector<bool> taken_;
};

}  // namespace

void LocalMap::add_key_frame(const RectifiedFrame& frame, const DisparityImage& disparity,
                             FrameFeatures features, const SE3& odometry_from_camera,
                             std::vector<Sighting> sightings) {
  KeyFrame key_frame{.id = next_key_frame_++,
                     .odometry_from_camera = odometry_from_camera,
                     .left = frame.left,
                     .features = std::move(features),
                     .sightings = std::move(sightings)};
  for (const Sighting& s : key_frame.sightings) add_sighting(s, key_frame);
  add_landmarks(frame, disparity, key_frame);
  key_frames_.push_back(std::move(key_frame));
  if (static_cast<int>(key_frames_.size()) > max_key_frames_) forget_oldest();
}

void LocalMap::add_sighting(const Sighting& sighting, const KeyFrame& key_frame) {
  Landmark& landmark = landmarks_.at(sighting.landmark);
  landmark.last_key_frame = key_frame.id;
  landmark.seen.push_back({key_frame.odometry_from_camera.inverse(), sighting.pixel, sighting.view_change});
  if (static_cast<int>(landmark.seen.size()) > max_key_frames_ + 1)
    landmark.seen.erase(landmark.seen.begin() + 1);
  const auto placed = refine_point(camera_, landmark.seen, landmark.in_odometry, disparity_sigma_px_);
  if (!placed) return;
  landmark.in_odometry = placed->in_odometry;
  landmark.covariance = placed->covariance;
}

void LocalMap::add_landmarks(const RectifiedFrame& frame, const DisparityImage& disparity,
                             KeyFrame& key_frame) {
  Spacing spacing(frame.left.width, frame.left.height);
  for (const Sighting& s : key_frame.sightings) spacing.take(s.pixel.head<2>());
  const FrameFeatures& features = key_frame.features;
  for (std::size_t i = 0; i < features.corners.size(); ++i) {
    if (static_cast<int>(key_frame.sightings.size()) >= max_landmarks_) return;
    const Eigen::Vector2d px = features.corners[i].px.cast<double>();
    if (!spacing.is_free(px)) continue;
    const Slant slant = slant_at(disparity, features.corners[i].px, features.disparity_px[i]);
    const auto d = refine_disparity(frame, px, features.disparity_px[i], slant);
    if (!d) continue;
    spacing.take(px);
    const StereoPixel pixel(px.x(), px.y(), *d);
    Landmark landmark = make_landmark(camera_, frame, key_frame.odometry_from_camera, pixel, slant,
                                      next_landmark_++, disparity_sigma_px_);
    landmark.last_key_frame = key_frame.id;
    key_frame.sightings.push_back({landmark.id, pixel});
    landmarks_.emplace(landmark.id, std::move(landmark));
  }
}

void LocalMap::forget_oldest() {
  key_frames_.pop_front();
  const std::int64_t oldest = key_frames_.front().id;
  std::erase_if(landmarks_, [oldest](const auto& entry) { return entry.second.last_key_frame < oldest; });
}

FoundLandmarks LocalMap::find(const RectifiedFrame& frame, const SE3& odometry_from_camera,
                              double radius_px) const {
  std::vector<const Landmark*> newest_first;
  for (const auto& [id, landmark] : landmarks_) newest_first.push_back(&landmark);
  std::stable_sort(newest_first.begin(), newest_first.end(), [](const Landmark* a, const Landmark* b) {
    return a->last_key_frame > b->last_key_frame;
  });
  const SE3 camera_from_odometry = odometry_from_camera.inverse();
  Spacing spacing(frame.left.width, frame.left.height);
  FoundLandmarks found;
  for (const Landmark* landmark : newest_first) {
    if (static_cast<int>(found.sightings.size()) >= max_landmarks_) break;
    const auto expected = expected_pixel(camera_, *landmark, camera_from_odometry);
    if (!expected || !spacing.is_free(expected->head<2>())) continue;
    const auto sighting = find_landmark(camera_, frame, *landmark, camera_from_odometry, radius_px);
    if (!sighting) {
      found.missed.push_back(landmark->id);
    } else if (spacing.is_free(sighting->pixel.head<2>())) {
      spacing.take(sighting->pixel.head<2>());
      found.sightings.push_back(*sighting);
    }
  }
  return found;
}

void LocalMap::note(const std::vector<std::int64_t>& found, const std::vector<std::int64_t>& missed) {
  for (const std::int64_t id : found) ++landmarks_.at(id).num_found;
  for (const std::int64_t id : missed) {
    const auto entry = landmarks_.find(id);
    if (++entry->second.num_missed > kMissesForgiven + entry->second.num_found) landmarks_.erase(entry);
  }
}

void LocalMap::clear() {
  key_frames_.clear();
  landmarks_.clear();
}

}  // namespace flogmap
