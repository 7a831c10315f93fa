#include "server/commands/mapping_session.hpp"

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "camera/calibration/distortion.hpp"
#include "mapping/odometry/trajectory_error.hpp"
#include "mapping/tile_memory.hpp"

namespace flogmap {
namespace {

using nlohmann::json;

/// From the rectified left camera to the frame that the user's poses are of.
SE3 frame_from_rectified(PosesFrame frame, const StereoCalibration& calibration, const Rectifier& rectifier) {
  const SE3 raw_from_rectified = rectifier.rectified_from_raw_left().inverse();
  switch (frame) {
    case PosesFrame::rectified:
      return SE3::Identity();
    case PosesFrame::raw:
      return raw_from_rectified;
    case PosesFrame::body:
      return calibration.body_from_left * raw_from_rectified;
  }
  return SE3::Identity();
}

std::optional<GivenPoses> read_poses(const Options& options, const SE3& frame_from_camera) {
  if (options.poses_file.empty()) return std::nullopt;
  std::map<std::int64_t, SE3> poses;
  const Trajectory trajectory = read_trajectory(options.poses_file);
  if (!trajectory.timed)
    throw UsageError(options.poses_file + ": poses need times; allowed: TUM or EuRoC csv");
  for (const TimedPose& timed : trajectory.poses) poses.emplace(timed.timestamp_ns, timed.world_from_camera);
  return GivenPoses(poses, frame_from_camera);
}

FrontEnd make_front_end(const Options& options, const StereoSource& source,
                        const StereoCalibration& calibration) {
  Rectifier rectifier(calibration);
  const SE3 frame_from_camera = frame_from_rectified(options.poses_frame, calibration, rectifier);
  FrontEndOptions front_end = options.front_end;
  if (options.first_pose) {
    front_end.first_world_from_camera = *options.first_pose * frame_from_camera;
  } else if (front_end.align == AlignMode::automatic) {
    // A simulated camera knows where it stands; then the map lies on the scene's own plan.
    front_end.first_world_from_camera = source.true_pose(source.info().first_timestamp_ns);
  }
  std::optional<Eigen::Vector3d> up = source.up_in_left_camera();
  if (up) up = rectifier.rectified_from_raw_left().linear() * *up;
  return {front_end, std::move(rectifier), read_poses(options, frame_from_camera), up};
}

MappingSession open_unchecked(const Options& options) {
  if (options.source.spec.empty()) throw UsageError("--source is missing; for instance --source sim:room");
  std::unique_ptr<StereoSource> source = open_source(options.source);
  const std::optional<StereoCalibration> calibration = source->calibration();
  if (!calibration) {
    throw UsageError(options.source.spec + ": carries no calibration; give one with --calibration FILE");
  }
  FrontEnd front_end = make_front_end(options, *source, *calibration);
  MapIntegrator integrator(options.flog, front_end.camera(), front_end.max_disparity_px());
  return {std::move(source), *calibration, std::move(front_end), std::move(integrator)};
}

json camera_json(const CameraIntrinsics& camera) {
  return {{"width_px", camera.width_px},
          {"height_px", camera.height_px},
          {"fx_px", camera.fx_px},
          {"fy_px", camera.fy_px},
          {"cx_px", camera.cx_px},
          {"cy_px", camera.cy_px},
          {"distortion", name_of(camera.distortion)},
          {"coefficients", camera.coefficients}};
}

}  // namespace

void limit_map_memory(const Options& options) {
  if (options.map_memory_mb == 0) return;
  namespace fs = std::filesystem;
  const char* temporary = std::getenv("TMPDIR");
  fs::path folder = temporary != nullptr ? temporary : "/var/tmp";  // not /tmp, which may be memory itself
  if (!options.out_dir.empty()) folder = options.out_dir;
  if (!options.store.empty()) folder = fs::absolute(options.store).parent_path();
  try {
    TileMemory::keep_within(static_cast<std::size_t>(options.map_memory_mb) << 20U, folder);
  } catch (const std::exception& error) {
    throw UsageError("--map-memory " + std::to_string(options.map_memory_mb) + ": " + error.what());
  }
}

MappingSession open_session(const Options& options) {
  try {
    return open_unchecked(options);
  } catch (const UsageError&) {
    throw;
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

std::optional<LoopOptions> loop_options(const Options& options) {
  if (!options.loop_closure || !options.poses_file.empty()) return std::nullopt;
  return LoopOptions{};
}

std::string calibration_json(const StereoCalibration& calibration, const StereoCamera& rectified) {
  json right_from_left = json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      right_from_left.push_back(calibration.right_from_left(row, column));
  }
  const json document = {{"dialect", calibration.dialect},
                         {"left", camera_json(calibration.left)},
                         {"right", camera_json(calibration.right)},
                         {"right_from_left", right_from_left},
                         {"already_rectified", calibration.rectified},
                         {"rectified",
                          {{"focal_px", rectified.focal_px},
                           {"cx_px", rectified.cx_px},
                           {"cy_px", rectified.cy_px},
                           {"baseline_m", rectified.baseline_m},
                           {"width_px", rectified.width_px},
                           {"height_px", rectified.height_px}}}};
  return document.dump();
}

}  // namespace flogmap
