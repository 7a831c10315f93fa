// The vision chain on a recording.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "camera/source_spec.hpp"
#include "mapping/front_end.hpp"
#include "mapping/odometry/trajectory_error.hpp"

namespace flogmap::test {

/// What the chain makes of a recording.
struct RecordingRun {
  StereoCamera camera;
  double max_disparity_px = 0;
  std::vector<Tracking> trackings;  // one per frame
  std::vector<View> views;          // that a map would take
  Trajectory path;                  // frames with a pose
};

/// `change` may spoil a frame before it is processed; it is told its number.
inline RecordingRun run_recording(const std::string& kind, const std::filesystem::path& folder,
                                  const FrontEndOptions& options,
                                  const std::function<void(StereoFrame&, int)>& change = {}) {
  const auto source =
      open_source({.spec = kind + ":" + folder.string(), .calibration_file = {}, .loop = false, .seed = 1});
  FrontEnd front_end(options, Rectifier(*source->calibration()), std::nullopt, std::nullopt);
  RecordingRun run;
  run.camera = front_end.camera();
  run.max_disparity_px = front_end.max_disparity_px();
  const auto take = [&](FrontEndResult& result) {
    for (View& view : result.views) run.views.push_back(std::move(view));
    for (const TrajectoryEntry& entry : result.path) {
      run.path.poses.push_back({entry.timestamp_ns, entry.world_from_camera});
    }
  };
  int number = 0;
  while (auto frame = source->next()) {
    if (change) change(*frame, number++);
    FrontEndResult result = front_end.process(*frame);
    take(result);
    run.trackings.push_back(std::move(result.tracking));
  }
  FrontEndResult rest = front_end.finish();
  take(rest);
  return run;
}

}  // namespace flogmap::test
