// flogmap evaluate: an estimated path against the true one, or a map against the truth.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "mapping/odometry/trajectory_error.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/evaluate_map.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

struct EvaluateArguments {
  std::string trajectory;
  std::string ground_truth;
  std::string map;
  std::string truth;
  int tolerance_cells = 2;
  bool json = false;
  OptionTable table;
};

using Reader = Trajectory (*)(const std::filesystem::path& file);

Trajectory read_input(const char* option, const std::string& file, Reader read) {
  if (file.empty()) throw UsageError(std::string(option) + " is missing; see flogmap evaluate --help");
  try {
    return read(file);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

TrajectoryError compare(const Trajectory& estimate, const Trajectory& truth,
                        const EvaluateArguments& arguments) {
  try {
    return evaluate_trajectory(estimate, truth);
  } catch (const std::exception& error) {
    throw UsageError(arguments.trajectory + " and " + arguments.ground_truth + ": " + error.what());
  }
}

void print_table(const TrajectoryError& error, std::size_t num_estimated) {
  std::printf("poses    %d of %zu found a partner; the true path is %.3f m long\n", error.num_poses,
              num_estimated, error.path_length_m);
  std::printf("ATE      rmse %.5f m, max %.5f m   (after the best SE(3) alignment, no scale)\n",
              error.ate_rmse_m, error.ate_max_m);
  std::printf("RPE      rmse %.5f m, %.4f deg   (from one pose to the next)\n", error.rpe_rmse_m,
              error.rpe_rmse_deg);
  std::printf("drift    %.3f %%, %.4f deg/m\n", error.drift_percent, error.drift_deg_per_m);
  std::printf("end      %.5f m, %.4f deg   (with the first pose taken as exact)\n", error.end_error_m,
              error.end_error_deg);
}

void print_json(const TrajectoryError& error) {
  const nlohmann::json document = {{"poses", error.num_poses},
                                   {"path_length_m", error.path_length_m},
                                   {"ate_rmse_m", error.ate_rmse_m},
                                   {"ate_max_m", error.ate_max_m},
                                   {"rpe_rmse_m", error.rpe_rmse_m},
                                   {"rpe_rmse_deg", error.rpe_rmse_deg},
                                   {"drift_percent", error.drift_percent},
                                   {"drift_deg_per_m", error.drift_deg_per_m},
                                   {"end_error_m", error.end_error_m},
                                   {"end_error_deg", error.end_error_deg}};
  std::printf("%s\n", document.dump(2).c_str());
}

int evaluate(const EvaluateArguments& arguments) {
  if (!arguments.map.empty() && !arguments.trajectory.empty()) {
    throw UsageError("--trajectory " + arguments.trajectory + " and --map " + arguments.map +
                     ": allowed is one of them at a time");
  }
  if (!arguments.map.empty()) {
    if (arguments.truth.empty())
      throw UsageError("--truth is missing: a folder with layer_<k>.png and .json");
    evaluate_map(arguments.map, arguments.truth, arguments.tolerance_cells, arguments.json);
    return 0;
  }
  const Trajectory estimate = read_input("--trajectory", arguments.trajectory, read_trajectory);
  // Two of KITTI's kind belong together line by line.
  const Trajectory truth = read_input("--ground-truth", arguments.ground_truth,
                                      estimate.timed ? read_true_trajectory : read_trajectory);
  const TrajectoryError error = compare(estimate, truth, arguments);
  if (arguments.json) {
    print_json(error);
  } else {
    print_table(error, estimate.poses.size());
  }
  return 0;
}

}  // namespace

RunCommand add_evaluate(CLI::App& app) {
  auto arguments = std::make_shared<EvaluateArguments>();
  OptionTable& table = arguments->table;
  table.text("trajectory", "FILE", arguments->trajectory,
             "estimated path, TUM: timestamp tx ty tz qx qy qz qw");
  table.text("ground-truth", "FILE", arguments->ground_truth,
             "true path: TUM, EuRoC csv, or KITTI poses with their times.txt beside them or in sequences/");
  table.text("map", "map.flog", arguments->map, "instead: a stored map");
  table.text("truth", "DIR", arguments->truth,
             "true occupancy: layer_<k>.png and .json, surface_<k>.png or seen_<k>.png if known");
  table.integer("tolerance", "CELLS", arguments->tolerance_cells, 0, 100,
                "a surface may be so many cells off");
  table.flag("json", arguments->json, "print one JSON object instead of a table");
  table.attach(app);
  app.footer(
      "Examples: flogmap evaluate --trajectory /tmp/map/trajectory.tum --ground-truth groundtruth.tum\n"
      "          flogmap evaluate --map /tmp/map/map.flog --truth truth");
  return [arguments] {
    arguments->table.apply(all_option_names());
    return evaluate(*arguments);
  };
}

}  // namespace flogmap
