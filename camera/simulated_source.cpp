#include "camera/simulated_source.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace flogmap {
namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;  // any date will do, but 0 is no date

std::int64_t frames_of(const Scene& scene, const Walk& walk) {
  if (scene.num_frames > 0) return scene.num_frames;
  return scene.path.closed ? 0 : static_cast<std::int64_t>(std::ceil(walk.round_s() * scene.rate_hz));
}

}  // namespace

StereoCalibration ideal_calibration(const StereoCamera& camera, const std::string& origin) {
  StereoCalibration calibration;
  calibration.left = {camera.width_px, camera.height_px, camera.focal_px,  camera.focal_px,
                      camera.cx_px,    camera.cy_px,     Distortion::none, {}};
  calibration.right = calibration.left;
  calibration.right_from_left.translation() = Eigen::Vector3d(-camera.baseline_m, 0, 0);
  calibration.rectified = true;
  calibration.dialect = "simulated";
  calibration.origin = origin;
  return calibration;
}

SimulatedSource::SimulatedSource(std::string spec, const Scene& scene, std::uint64_t seed)
    : spec_(std::move(spec)),
      renderer_(scene),
      walk_(scene.path, scene.rate_hz, seed),
      sensor_(scene.sensor, seed),
      num_frames_(frames_of(scene, walk_)) {}

std::int64_t SimulatedSource::timestamp(std::int64_t frame) const {
  return kStartNs + std::llround(1e9 * static_cast<double>(frame) / scene().rate_hz);
}

double SimulatedSource::seconds(std::int64_t timestamp_ns) const {
  return 1e-9 * static_cast<double>(timestamp_ns - kStartNs);
}

Picture SimulatedSource::picture(const Eigen::Isometry3d& world_from_camera, double time_s,
                                 RenderedView& view, bool right) {
  renderer_.render(world_from_camera, time_s, view);
  sensor_.expose(view.grey, frame_, right);
  return {view.grey.width, view.grey.height, 1, 8, view.grey.pixels};
}

std::optional<StereoFrame> SimulatedSource::next() {
  while (!stopped_ && (num_frames_ == 0 || frame_ < num_frames_)) {
    if (sensor_.drops(frame_)) {
      skipped_ = {skipped_.count + 1,
                  "frame " + std::to_string(frame_) + ": dropped by the simulated camera"};
      ++frame_;
      continue;
    }
    const std::int64_t time_ns = timestamp(frame_);
    const double left_s = seconds(time_ns), right_s = left_s + scene().sensor.skew_s;
    const Eigen::Isometry3d right_pose =
        walk_.pose(right_s) * Eigen::Translation3d(scene().camera.baseline_m, 0, 0);
    StereoFrame frame{time_ns, picture(walk_.pose(left_s), left_s, left_, false),
                      picture(right_pose, right_s, right_, true)};
    ++frame_;
    return frame;
  }
  return std::nullopt;
}

SourceInfo SimulatedSource::info() const {
  SourceInfo info{.spec = spec_,
                  .live = false,
                  .endless = num_frames_ == 0,
                  .num_frames = std::nullopt,
                  .first_timestamp_ns = timestamp(0),
                  .last_timestamp_ns = std::numeric_limits<std::int64_t>::max()};
  if (num_frames_ > 0) {
    info.num_frames = num_frames_;
    info.last_timestamp_ns = timestamp(num_frames_ - 1);
  }
  return info;
}

std::optional<StereoCalibration> SimulatedSource::calibration() const {
  return ideal_calibration(scene().camera, spec_);
}

bool SimulatedSource::seek(std::int64_t timestamp_ns) {
  frame_ = std::max<std::int64_t>(
      0, static_cast<std::int64_t>(std::floor(seconds(timestamp_ns) * scene().rate_hz)));
  while (timestamp(frame_) < timestamp_ns) ++frame_;
  return true;
}

std::optional<Eigen::Vector3d> SimulatedSource::up_in_left_camera() const {
  return Eigen::Vector3d(walk_.pose(0).linear().transpose() * Eigen::Vector3d::UnitZ());
}

std::optional<Eigen::Isometry3d> SimulatedSource::true_pose(std::int64_t timestamp_ns) const {
  return walk_.pose(seconds(timestamp_ns));
}

Image<float> SimulatedSource::true_depth() const {
  Image<float> depth = left_.inverse_depth;
  for (float& value : depth.pixels) value = 1.0F / value;
  return depth;
}

}  // namespace flogmap
