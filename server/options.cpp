#include "server/options.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace flogmap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kMaxThreads = 256;

std::string joined(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) {
    std::string digits = std::to_string(number);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.ends_with('.')) digits.pop_back();
    text += (text.empty() ? "" : ",") + digits;
  }
  return text;
}

std::vector<double> parse_layers(const std::string& text) {
  GridSpec grid;
  grid.layer_bounds_m = parse_numbers(text, 0);
  try {
    check(grid);
  } catch (const std::exception&) {
    throw UsageError("allowed: 2 to 65 heights in metres, each at least 0.001 above the one before");
  }
  return grid.layer_bounds_m;
}

SE3 parse_pose(const std::string& given) {
  const std::vector<double> n = parse_numbers(given, 7);
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  if (std::abs(q.norm() - 1) > 0.01) {
    throw UsageError("qx,qy,qz,qw must have length 1, has " + std::to_string(q.norm()));
  }
  SE3 pose = SE3::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
  return pose;
}

std::string pose_text(const SE3& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return joined({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

/// A whole number or the word "auto", which is kept as 0.
Option auto_integer(const std::string& name, int& target, int low, int high, const std::string& help) {
  const auto parse = [&target, low, high](const std::string& given) {
    if (given == "auto") {
      target = 0;
      return;
    }
    const double value = parse_numbers(given, 1)[0];
    if (value < low || value > high || value != std::floor(value)) {
      throw UsageError("allowed: auto, or whole numbers from " + std::to_string(low) + " to " +
                       std::to_string(high));
    }
    target = static_cast<int>(value);
  };
  return {.name = name, .value_name = "N|auto", .help = help, .parse = parse, .show = [&target] {
            return target == 0 ? std::string("auto") : std::to_string(target);
          }};
}

void add_grid_options(OptionTable& table, Options& options) {
  FlogOptions& flog = options.flog;
  table.number("cell-size", "METRES", flog.grid.cell_size_m, 0.002, 1, "side of a cell");
  table.add({.name = "layers",
             .value_name = "Z0,Z1,...",
             .help = "boundaries of the layers, metres above the floor; start 3-5 cm above it",
             .parse = [&flog](const std::string& text) { flog.grid.layer_bounds_m = parse_layers(text); },
             .show = [&flog] { return joined(flog.grid.layer_bounds_m); }});
  table.number("max-range", "METRES", flog.max_range_m, 0.1, 1000,
               "farther points only say where it is free");
  table.number("max-incidence", "DEGREES", flog.max_incidence_deg, 30, 90,
               "pixels that see a surface at more than this from its normal are left out; 90 = none");
  table.integer("row-step", "N", flog.row_step, 1, 64, "use every N-th row of a view");
  table.number("view-translation-cells", "CELLS", options.front_end.views.translation_cells, 0.001, 1e6,
               "a view is mapped if the camera moved this far since the last mapped one");
  table.number("view-translation", "METRES", options.front_end.views.translation_m, 0, 1000,
               "the same in metres; 0 = by cells");
  table.add({.name = "view-rotation-deg",
             .value_name = "DEGREES",
             .help = "... or turned this far; 0 = half the field of view",
             .parse =
                 [&options](const std::string& text) {
                   const double degrees = parse_numbers(text, 1)[0];
                   if (degrees < 0 || degrees > 180) throw UsageError("allowed: 0 to 180");
                   options.front_end.views.rotation_rad = degrees * kDegree;
                 },
             .show = [&options] { return joined({options.front_end.views.rotation_rad / kDegree}); }});
  table.number("full-confidence-rays", "N", flog.full_confidence_rays, 0, 65535,
               "rays after which a cell is known for sure; 0 = derived from camera and cell size");
  table.integer("min-rays", "N", flog.min_rays, 1, 65535, "a cell counts as seen from this many rays on");
  table.choice<IntegratorKind>("integrator", flog.integrator,
                               {{"fan", IntegratorKind::fan}, {"ray", IntegratorKind::ray}},
                               "fan: fast; ray: one ray after the other, the reference");
  table.flag("paper-mode", flog.paper_mode,
             "literally as in the paper: no floor of the error, eq. (5) as printed");
}

void add_start_options(OptionTable& table, Options& options) {
  table.text("poses", "FILE", options.poses_file,
             "map with these poses (TUM or EuRoC csv) instead of the estimated motion");
  table.choice<PosesFrame>(
      "poses-frame", options.poses_frame,
      {{"rectified", PosesFrame::rectified}, {"raw", PosesFrame::raw}, {"body", PosesFrame::body}},
      "what --poses and --first-pose are poses of: the rectified or the raw left camera, or the body");
  table.add(
      {.name = "first-pose",
       .value_name = "x,y,z,qx,qy,qz,qw",
       .help = "where the camera stands at first, in the world (z up, floor at 0)",
       .parse = [&options](const std::string& text) { options.first_pose = parse_pose(text); },
       .show = [&options] { return options.first_pose ? pose_text(*options.first_pose) : std::string(); }});
  table.choice<AlignMode>("align", options.front_end.align,
                          {{"auto", AlignMode::automatic},
                           {"none", AlignMode::none},
                           {"gravity", AlignMode::gravity},
                           {"ground", AlignMode::ground}},
                          "how the world is levelled without --first-pose");
}

/// "1280x720"
void parse_camera_size(std::string text, SourceOptions& source) {
  std::replace(text.begin(), text.end(), 'x', ',');
  const std::vector<double> size = parse_numbers(text, 2);
  if (std::min(size[0], size[1]) < 0 || std::max(size[0], size[1]) > 16384)
    throw UsageError("allowed: 0x0 (640x480) to 16384x16384");
  source.camera_width_px = static_cast<int>(size[0]);
  source.camera_height_px = static_cast<int>(size[1]);
}

}  // namespace

void add_seed_option(OptionTable& table, std::uint64_t& seed, const std::string& help) {
  const auto parse = [&seed](const std::string& text) {
    const double value = parse_numbers(text, 1)[0];
    if (value < 0 || value > 4294967295.0 || value != std::floor(value)) {
      throw UsageError("allowed: whole numbers from 0 to 4294967295");
    }
    seed = static_cast<std::uint64_t>(value);
  };
  table.add({.name = "seed", .value_name = "N", .help = help, .parse = parse, .show = [&seed] {
               return std::to_string(seed);
             }});
}

void add_source_options(OptionTable& table, Options& options) {
  table.text("source", "SPEC", options.source.spec,
             "kind:where; kinds: " + source_kinds() + "; for instance euroc:DIR or sim:room");
  table.text("calibration", "FILE", options.source.calibration_file, "instead of what the source carries");
  add_seed_option(table, options.source.seed, "of everything random; the same seed gives the same map");
  table.number(
      "frame-rate", "HZ", options.source.frame_rate_hz, 0.01, 1000,
      "of pictures whose times nothing says: kitti: without times.txt, images: without times in names");
  table.number("camera-rate", "HZ", options.source.camera_rate_hz, 0.5, 240, "of live cameras");
  table.add({.name = "camera-size",
             .value_name = "WIDTHxHEIGHT",
             .help = "of live cameras that no calibration is given for",
             .parse = [&options](const std::string& text) { parse_camera_size(text, options.source); },
             .show =
                 [&options] {
                   return std::to_string(options.source.camera_width_px) + "x" +
                          std::to_string(options.source.camera_height_px);
                 }});
  table.number("max-skew-ms", "MS", options.source.max_skew_ms, 0.01, 1000,
               "live and mcap: pairs taken further apart are dropped");
  table.number("exposure-us", "US", options.source.exposure_us, 0, 1e6,
               "live: of both cameras; 0 = automatic, the right one like the left one");
  table.number("gain", "FACTOR", options.source.gain, 0, 1000, "live: likewise");
}

void add_stereo_options(OptionTable& table, StereoOptions& stereo) {
  table.choice<MatcherKind>("matcher", stereo.matcher,
                            {{"block", MatcherKind::block}, {"sgm", MatcherKind::sgm}},
                            "dense stereo method");
  table.integer("min-disparity", "PX", stereo.min_disparity, -256, 1024, "smallest disparity searched");
  table.add(auto_integer("num-disparities", stereo.num_disparities, 1, 256,
                         "how many disparities are searched; auto = as --nearest needs"));
  table.number("nearest", "METRES", stereo.nearest_m, 0.01, 1000, "nothing nearer than this is expected");
}

void add_mapping_options(OptionTable& table, Options& options) {
  add_grid_options(table, options);
  add_stereo_options(table, options.front_end.stereo);
  add_start_options(table, options);
  table.choice<Operators>("operators", options.serve.operators,
                          {{"algebraic", Operators::algebraic},
                           {"minmax", Operators::minmax},
                           {"lukasiewicz", Operators::lukasiewicz}},
                          "fuzzy and, or and not of the map's rules");
  table.choice<bool>("loop-closure", options.loop_closure, {{"on", true}, {"off", false}},
                     "recognise places seen before and correct path and map");
  table.integer(
      "map-memory", "MB", options.map_memory_mb, 0, 1 << 20,
      "cells of the map kept in memory, about; others lie in a file and come back when needed; 0 = all");
  table.integer(
      "view-memory", "MB", options.view_memory_mb, 1, 1 << 20,
      "views kept to build the map anew after a loop or levelling; beyond it the oldest stay as they are");
  table.integer("threads", "N", options.num_threads, 0, kMaxThreads,
                "per stage; 0 = every core. Same map for any N");
}

std::vector<std::string> all_option_names() {
  Options options;
  OptionTable table;
  add_source_options(table, options);
  add_mapping_options(table, options);
  add_serve_options(table, options);
  std::vector<std::string> names = table.names();
  names.insert(
      names.end(),
      {"b-in-a",       "board",     "depth-views", "dictionary", "duration",   "format",    "frames",
       "ground-truth", "json",      "layer",       "left",       "map",        "marker-mm", "max-frames",
       "model",        "out",       "pattern",     "pictures",   "right",      "scale",     "scene",
       "serve",        "square-mm", "tag-gap",     "tolerance",  "trajectory", "truth"});
  return names;
}

void settle(Options& options) {
  options.flog.num_threads = options.num_threads;
  options.front_end.stereo.num_threads = options.num_threads;
  options.front_end.views.cell_size_m = options.flog.grid.cell_size_m;
  try {
    check(options.flog);
    check(options.front_end.stereo);
    check(options.front_end.views);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

}  // namespace flogmap
