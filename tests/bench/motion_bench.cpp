// The odometry on every recording with true poses under FLOGMAP_DATA: errors of the path and time per frame,
// and the path once loops are closed. Prints a table (--markdown: one for the docs) and writes
// build/bench/motion.json (or the path in the last argument).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera/rectifier.hpp"
#include "camera/source_spec.hpp"
#include "mapping/flog/view_selector.hpp"
#include "mapping/loop/corrected_path.hpp"
#include "mapping/loop/loop_closer.hpp"
#include "mapping/odometry/stereo_odometry.hpp"
#include "mapping/odometry/trajectory_error.hpp"
#include "mapping/stereo/disparity_matcher.hpp"
#include "mapping/stereo/segment_filter.hpp"

namespace flogmap {
namespace {

struct Recording {
  std::string name;
  std::string kind;                    // of the source
  std::string truth;                   // file in its folder
  int every = 1;                       // frames from one to the next
  int cover_from = -1, cover_to = -1;  // the lens is covered during these frames

  [[nodiscard]] std::string title() const {
    if (cover_from >= 0) return name + "_covered";
    return every == 1 ? name : name + "_every_" + std::to_string(every);
  }
};

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

struct Result {
  std::string name;
  TrajectoryError error, looped;  // without and with loops closed
  int num_frames = 0, num_lost = 0, num_key_frames = 0, num_views = 0, num_loops = 0;
  double median_cpu_ms = 0, p95_cpu_ms = 0, median_loop_ms = 0;
};

/// Finds loops in the views that a map takes, 8 cm or half a field of view apart.
class LoopedPath {
 public:
  explicit LoopedPath(const StereoCamera& camera) : selector_({}, camera), closer_({}, camera) {}

  void add(const RectifiedFrame& frame, const DisparityImage& disparity, const Tracking& tracking) {
    if (std::exchange(segment_, tracking.segment) != tracking.segment) selector_.reset();
    const SE3& pose = tracking.odometry_from_camera;
    path_.add({{frame.timestamp_ns, pose, tracking.state, false, tracking.segment}});
    if (tracking.state != TrackingState::ok || !selector_.accept(pose)) return;
    const View view{frame.timestamp_ns, pose, disparity, frame.left, tracking.segment};
    const double before = cpu_ms();
    if (auto correction = closer_.add(view)) path_.correct(std::move(correction->path));
    times_ms_.push_back(cpu_ms() - before);
  }
  [[nodiscard]] std::vector<TrajectoryEntry> path() const { return path_.corrected(); }
  [[nodiscard]] int num_loops() const { return closer_.num_loops(); }
  [[nodiscard]] const std::vector<double>& times_ms() const { return times_ms_; }

 private:
  ViewSelector selector_;
  LoopCloser closer_;
  CorrectedPath path_;
  int segment_ = 0;
  std::vector<double> times_ms_;
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void cover(RectifiedFrame& frame, DisparityImage& disparity) {
  std::fill(frame.left.pixels.begin(), frame.left.pixels.end(), std::uint8_t{3});
  frame.right = frame.left;
  std::fill(disparity.px.pixels.begin(), disparity.px.pixels.end(), std::numeric_limits<float>::quiet_NaN());
}

/// Keeps the true poses of the frames that were placed, for truths without times.
Trajectory only(const Trajectory& truth, const std::vector<std::size_t>& frames) {
  Trajectory chosen;
  chosen.timed = truth.timed;
  for (const std::size_t i : frames) chosen.poses.push_back(truth.poses.at(i));
  return chosen;
}

Result run(const Recording& recording, const std::filesystem::path& folder) {
  const auto source = open_source({.spec = recording.kind + ":" + folder.string(), .calibration_file = {}});
  const Rectifier rectifier(*source->calibration());
  const StereoCamera camera = rectifier.camera();
  const StereoOptions stereo;
  const auto matcher = make_matcher(stereo, camera);
  StereoOdometry odometry({}, camera);
  Result result;
  result.name = recording.title();
  Trajectory estimate, looped;
  LoopedPath loops(camera);
  std::map<std::int64_t, std::size_t> number_of;  // frame, by time
  std::vector<std::size_t> placed, placed_looped;
  std::vector<double> times;
  int index = -1;
  while (const auto raw = source->next()) {
    if (++index % recording.every != 0) continue;
    RectifiedFrame frame = rectifier.rectify(*raw);
    DisparityImage disparity = matcher->match(frame);
    remove_small_segments(disparity, min_segment_px(stereo, camera));
    if (index >= recording.cover_from && index < recording.cover_to) cover(frame, disparity);
    const double before = cpu_ms();
    const Tracking tracking = odometry.track(frame, disparity);
    times.push_back(cpu_ms() - before);
    ++result.num_frames;
    result.num_key_frames += tracking.new_key_frame ? 1 : 0;
    result.num_lost += tracking.has_pose() ? 0 : 1;
    if (!tracking.has_pose()) continue;
    estimate.poses.push_back({frame.timestamp_ns, tracking.odometry_from_camera});
    placed.push_back(static_cast<std::size_t>(index));
    number_of[frame.timestamp_ns] = placed.back();
    loops.add(frame, disparity, tracking);
  }
  for (const TrajectoryEntry& entry : loops.path()) {
    looped.poses.push_back({entry.timestamp_ns, entry.world_from_camera});
    placed_looped.push_back(number_of.at(entry.timestamp_ns));
  }
  const Trajectory truth = read_trajectory(folder / recording.truth);
  result.error = evaluate_trajectory(estimate, truth.timed ? truth : only(truth, placed));
  result.looped = evaluate_trajectory(looped, truth.timed ? truth : only(truth, placed_looped));
  result.num_views = static_cast<int>(loops.times_ms().size());
  result.num_loops = loops.num_loops();
  result.median_loop_ms = quantile(loops.times_ms(), 0.5);
  result.median_cpu_ms = quantile(times, 0.5);
  result.p95_cpu_ms = quantile(times, 0.95);
  return result;
}

void print_row(const Result& r, bool markdown) {
  const TrajectoryError& e = r.error;
  const auto print = [&](const char* format) {
    std::printf(format, r.name.c_str(), r.num_frames, r.num_lost, e.path_length_m, e.ate_rmse_m, e.rpe_rmse_m,
                e.rpe_rmse_deg, e.drift_percent, e.drift_deg_per_m, e.end_error_m, r.median_cpu_ms,
                r.p95_cpu_ms);
  };
  if (markdown) {
    print("| %s | %d | %d | %.1f | %.4f | %.4f | %.3f | %.2f | %.3f | %.3f | %.1f | %.1f |\n");
  } else {
    print("%-28s %5d %4d %7.1f %8.4f %8.4f %7.3f %6.2f %8.3f %7.3f %7.1f %6.1f\n");
  }
}

void print_head(bool markdown) {
  if (!markdown) {
    std::printf("%-28s %5s %4s %7s %8s %8s %7s %6s %8s %7s %7s %6s\n", "recording", "pairs", "lost", "path m",
                "ATE m", "RPE m", "RPE deg", "drift%", "deg/m", "end m", "CPU ms", "p95 ms");
    return;
  }
  std::printf(
      "| recording | frames | lost | path [m] | ATE [m] | RPE [m] | RPE [deg] | drift [%%] | drift [deg/m] | "
      "end [m] | CPU [ms] | p95 [ms] |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

/// What closing loops changes.
void print_loops(const Result& r, bool markdown) {
  const auto print = [&](const char* format) {
    std::printf(format, r.name.c_str(), r.num_views, r.num_loops, r.error.ate_rmse_m, r.looped.ate_rmse_m,
                r.error.end_error_m, r.looped.end_error_m, r.median_loop_ms);
  };
  print(markdown ? "| %s | %d | %d | %.4f → %.4f | %.3f → %.3f | %.1f |\n"
                 : "%-28s %5d %5d   %.4f -> %.4f   %.3f -> %.3f %6.1f\n");
}

void print_loops_head(bool markdown) {
  if (markdown) {
    std::printf(
        "\n| recording | views | loops | ATE [m] | end [m] | CPU per view [ms] "
        "|\n|---|---|---|---|---|---|\n");
  } else {
    std::printf("\n%-28s %5s %5s   %-16s   %-14s %6s\n", "loops closed", "views", "loops", "ATE m", "end m",
                "CPU ms");
  }
}

void add_to(nlohmann::json& json, const Result& r) {
  json[r.name + "_ate_m"] = r.error.ate_rmse_m;
  json[r.name + "_rpe_m"] = r.error.rpe_rmse_m;
  json[r.name + "_rpe_deg"] = r.error.rpe_rmse_deg;
  json[r.name + "_drift_percent"] = r.error.drift_percent;
  json[r.name + "_end_m"] = r.error.end_error_m;
  json[r.name + "_looped_ate_m"] = r.looped.ate_rmse_m;
  json[r.name + "_looped_end_m"] = r.looped.end_error_m;
  json[r.name + "_loops"] = r.num_loops;
  json[r.name + "_loop_cpu_ms"] = r.median_loop_ms;
  json[r.name + "_lost_frames"] = r.num_lost;
  json[r.name + "_cpu_ms"] = r.median_cpu_ms;
}

const std::vector<Recording> kRecordings{
    {"euroc_mh01_10hz", "euroc", "groundtruth_cam0.tum"},
    {"euroc_mh01_10hz", "euroc", "groundtruth_cam0.tum", 2},
    {"euroc_mh01_10hz", "euroc", "groundtruth_cam0.tum", 4},
    {"euroc_mh01_10hz", "euroc", "groundtruth_cam0.tum", 1, 50, 70},
    {"euroc_v101_still", "euroc", "groundtruth_cam0.tum"},
    {"kitti03", "kitti", "poses.txt"},
    {"two-boxes-near", "euroc", "groundtruth.tum"},
    {"two-boxes-far", "euroc", "groundtruth.tum"},
    {"house-dev", "euroc", "groundtruth.tum"},
    {"house-dev", "euroc", "groundtruth.tum", 3},
    {"house-dev", "euroc", "groundtruth.tum", 1, 100, 120},
};

int run_all(const std::filesystem::path& data, bool markdown, const std::filesystem::path& out) {
  nlohmann::json json;
  std::vector<Result> results;
  print_head(markdown);
  for (const Recording& recording : kRecordings) {
    const auto folder = data / recording.name;
    if (!std::filesystem::exists(folder)) {
      std::fprintf(stderr, "%s: not there, left out\n", folder.c_str());
      continue;
    }
    const Result result = run(recording, folder);
    print_row(result, markdown);
    std::fflush(stdout);
    add_to(json, result);
    results.push_back(result);
  }
  print_loops_head(markdown);
  for (const Result& result : results) print_loops(result, markdown);
  if (out.has_parent_path()) std::filesystem::create_directories(out.parent_path());
  std::ofstream(out) << json.dump(2) << "\n";
  return 0;
}

}  // namespace
}  // namespace flogmap

int main(int argc, char** argv) {
  const char* data = std::getenv("FLOGMAP_DATA");
  if (data == nullptr) {
    std::cerr << "motion_bench: set FLOGMAP_DATA to the folder with the recordings\n";
    return 2;
  }
  bool markdown = false;
  std::filesystem::path out = "build/bench/motion.json";
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--markdown") {
      markdown = true;
    } else {
      out = argv[i];
    }
  }
  try {
    return flogmap::run_all(data, markdown, out);
  } catch (const std::exception& error) {
    std::cerr << "motion_bench: " << error.what() << "\n";
    return 1;
  }
}
