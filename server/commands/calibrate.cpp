// flogmap calibrate: pictures of a board in, from files or from any source, a stereo calibration and a
// verdict out.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <thread>

#include "camera/board_calibration/board_detector.hpp"
#include "camera/board_calibration/verdict.hpp"
#include "camera/calibration/opencv_calibration.hpp"
#include "camera/grey.hpp"
#include "camera/images_source.hpp"
#include "camera/low_bits.hpp"
#include "camera/picture_files.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/interrupt_watcher.hpp"
#include "server/commands/live_desk.hpp"
#include "server/commands/output_path.hpp"
#include "server/commands/progress_bar.hpp"
#include "server/commands/serving.hpp"
#include "server/commands/stored_control.hpp"
#include "server/hub.hpp"
#include "server/log.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

constexpr double kMmPerM = 1000;
constexpr int kLeastBoard = 2, kMostBoard = 100;

struct CalibrateArguments {
  std::string left, right, out;
  BoardSpec board;
  double square_mm = 25;
  double marker_mm = 0;  // 0: the usual share of the square
  Distortion model = Distortion::radtan;
  Options options;  // of a source, and of a page that shows it
  bool serve = false;
};

void parse_board(const std::string& text, BoardSpec& board) {
  const std::size_t x = text.find('x');
  if (x == std::string::npos) throw UsageError("must be COLUMNSxROWS, for instance 9x6");
  const std::vector<double> size = parse_numbers(text.substr(0, x) + "," + text.substr(x + 1), 2);
  for (const double number : size) {
    if (number < kLeastBoard || number > kMostBoard || number != std::floor(number))
      throw UsageError(
          "allowed: COLUMNSxROWS, each a whole number from 2 (not of tags: 3) to 100, for instance 9x6");
  }
  board.columns = static_cast<int>(size[0]);
  board.rows = static_cast<int>(size[1]);
}

void add_options(OptionTable& table, CalibrateArguments& arguments) {
  BoardSpec& board = arguments.board;
  add_source_options(table, arguments.options);
  table.flag("serve", arguments.serve,
             "with --source: a page that shows the pictures and where to hold the board");
  add_listen_options(table, arguments.options);
  table.text("left", "GLOB", arguments.left, "pictures of the left camera, quoted: 'left*.png'");
  table.text("right", "GLOB", arguments.right, "pictures of the right camera, numbered alike");
  table.choice<BoardPattern>("pattern", board.pattern,
                             {{"chessboard", BoardPattern::chessboard},
                              {"charuco", BoardPattern::charuco},
                              {"apriltag", BoardPattern::apriltag}},
                             "what is printed on the board");
  table.add({.name = "board",
             .value_name = "COLUMNSxROWS",
             .help = "inner corners of a chessboard, squares of a ChArUco board, tags of an AprilTag grid",
             .parse = [&board](const std::string& text) { parse_board(text, board); },
             .show = [&board] { return std::to_string(board.columns) + "x" + std::to_string(board.rows); }});
  table.number("square-mm", "MM", arguments.square_mm, 0.1, 10000, "side of a square, or of a tag");
  table.number("marker-mm", "MM", arguments.marker_mm, 0, 10000,
               "ChArUco: side of a marker; 0 = three quarters of the square");
  table.number("tag-gap", "SHARE", board.tag_gap_share, 0.001, 2,
               "AprilTag grid: gap between tags / side of a tag");
  table.text("dictionary", "NAME", board.dictionary, "ChArUco: 4X4_50 to 6X6_1000; empty = found out");
  table.choice<Distortion>("model", arguments.model,
                           {{"radtan", Distortion::radtan},
                            {"rational", Distortion::rational},
                            {"fisheye", Distortion::equidistant}},
                           "lens: radtan for most, rational for wide ones, fisheye above about 110 degrees");
  table.text("out", "FILE.yaml", arguments.out, "the calibration, as OpenCV writes it");
}

/// What the pictures show, pair by pair.
struct Sightings {
  std::vector<BoardPair> pairs;
  std::vector<std::string> names;
  std::vector<std::string> problems;
  int width_px = 0, height_px = 0;
};

BoardSighting look_at(const std::filesystem::path& file, BoardDetector& detector, Sightings& sightings) {
  ReadPicture read = read_picture(file);
  if (!read.problem.empty()) return {{}, read.problem};
  Picture& picture = read.picture;
  shift_up(picture, unused_bits(picture));
  if (sightings.width_px == 0) sightings.width_px = picture.width, sightings.height_px = picture.height;
  if (picture.width != sightings.width_px || picture.height != sightings.height_px) {
    return {{},
            file.string() + ": " + std::to_string(picture.width) + "x" + std::to_string(picture.height) +
                " px, the others are " + std::to_string(sightings.width_px) + "x" +
                std::to_string(sightings.height_px)};
  }
  BoardSighting sighting = detector.find(to_grey(picture));
  if (!sighting.problem.empty()) sighting.problem = file.string() + ": " + sighting.problem;
  return sighting;
}

Sightings look_at_all(const CalibrateArguments& arguments) {
  const PicturePairList list = list_images(arguments.left + "," + arguments.right);
  BoardDetector detector(arguments.board);
  Sightings sightings;
  if (list.skipped.count > 0) sightings.problems.push_back(list.skipped.last_reason);
  ProgressBar progress("finding boards", std::ssize(list.pairs));
  for (std::size_t i = 0; i < list.pairs.size(); ++i) {
    BoardSighting left = look_at(list.pairs[i].left, detector, sightings);
    BoardSighting right = look_at(list.pairs[i].right, detector, sightings);
    for (const BoardSighting* sighting : {&left, &right}) {
      if (!sighting->problem.empty()) sightings.problems.push_back(sighting->problem);
    }
    if (arguments.board.pattern == BoardPattern::chessboard) match_directions(left.view, right.view);
    const bool one_is_enough = arguments.board.pattern != BoardPattern::chessboard;
    const bool seen =
        one_is_enough ? !left.view.empty() || !right.view.empty() : !left.view.empty() && !right.view.empty();
    if (seen) {
      sightings.pairs.push_back({std::move(left.view), std::move(right.view)});
      sightings.names.push_back(list.pairs[i].left.filename().string());
    }
    progress.show(static_cast<std::int64_t>(i + 1),
                  std::to_string(sightings.pairs.size()) + " pairs show the board");
  }
  progress.finish();
  return sightings;
}

void print_verdict(const CalibrationVerdict& verdict, const std::string& out) {
  constexpr double kDegreesPerRad = 180 / std::numbers::pi;
  std::printf("pairs            %zu with %zu corners (%zu left out as too far off)\n", verdict.num_pairs,
              verdict.num_corners + verdict.num_left_out, verdict.num_left_out);
  std::printf("rms              %.3f px\n", verdict.rms_px);
  std::printf("epipolar p95     %.3f px\n", verdict.epipolar_p95_px);
  std::printf("baseline         %.2f mm +- %.2f\n", kMmPerM * verdict.baseline_m,
              kMmPerM * verdict.baseline_sigma_m);
  std::printf("field of view    %.1f degrees (rectified, horizontal)\n",
              kDegreesPerRad * verdict.field_of_view_rad);
  std::printf("verdict          %s\n", grade_name(verdict.grade));
  for (const std::string& advice : verdict.advice) std::printf("to do: %s\n", advice.c_str());
  std::printf("written: %s\n", out.c_str());
}

CalibrationResult solve_with_bar(const CalibrateArguments& arguments, const Sightings& sightings) {
  constexpr std::int64_t kHundred = 100;
  ProgressBar progress("calibrating", kHundred);
  CalibratorOptions options{
      .model = arguments.model,
      .width_px = sightings.width_px,
      .height_px = sightings.height_px,
      .on_progress = [&](double share) { progress.show(static_cast<std::int64_t>(share * kHundred), ""); }};
  CalibrationResult result = calibrate_stereo(board_points(arguments.board), sightings.pairs, options);
  progress.finish();
  return result;
}

/// Serves the page until Ctrl-C, while the desk looks at the source.
void serve_desk(CalibrateArguments& arguments, LiveDesk& desk, StereoSource& source) {
  const LogScope log(arguments.options.log);
  const std::string& spec = arguments.options.source.spec;
  StoredControl control(spec, "nothing is mapped while cameras are calibrated");
  HubInfo info;
  info.version = FLOGMAP_VERSION;
  info.desk = &desk;
  Hub hub(arguments.options.serve, control, info);
  hub.drain_on_signals();
  std::exception_ptr failure;
  std::jthread looker([&] {
    try {
      desk.run(source, true);
    } catch (...) {
      failure = std::current_exception();
      hub.drain("the source failed");
    }
  });
  announce(arguments.options, hub.port(), "Calibrating " + spec, "/calibrate.html");
  hub.run();
  source.stop();
  desk.stop();
  looker.join();
  if (failure) std::rethrow_exception(failure);
}

int calibrate_source(CalibrateArguments& arguments) {
  if (arguments.serve) settle_serving(arguments.options);
  arguments.options.source.needs_calibration = false;
  std::unique_ptr<StereoSource> source;
  std::unique_ptr<LiveDesk> desk;
  try {
    source = open_source(arguments.options.source);
    const bool photos = arguments.options.source.spec.starts_with("images:");
    desk = std::make_unique<LiveDesk>(DeskOptions{arguments.board, arguments.model, photos, arguments.out});
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
  if (arguments.serve) {
    serve_desk(arguments, *desk, *source);
  } else {
    const InterruptWatcher ctrl_c([&] { source->stop(); });
    desk->run(*source, false);
  }
  if (!desk->problem().empty()) throw std::runtime_error(desk->problem());
  if (const auto verdict = desk->verdict()) print_verdict(*verdict, arguments.out);
  return 0;
}

void require(const std::string& name, const std::string& value) {
  if (value.empty()) throw UsageError(name + " is missing; see flogmap calibrate --help");
}

int calibrate(CalibrateArguments& arguments) {
  require("--out", arguments.out);
  check_output_file(arguments.out);
  arguments.board.square_m = arguments.square_mm / kMmPerM;
  if (arguments.marker_mm > 0) arguments.board.marker_share = arguments.marker_mm / arguments.square_mm;
  if (!arguments.options.source.spec.empty()) return calibrate_source(arguments);
  require("--left (or --source)", arguments.left);
  require("--right", arguments.right);
  Sightings sightings;
  try {
    sightings = look_at_all(arguments);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
  if (sightings.pairs.empty() && !sightings.problems.empty())
    throw UsageError("no pair shows the board; last: " + sightings.problems.back());
  const CalibrationResult result = solve_with_bar(arguments, sightings);
  const CalibrationVerdict verdict = judge(result, sightings.names);
  std::ofstream out(arguments.out, std::ios::binary | std::ios::trunc);
  out << format_opencv(result.calibration) << std::flush;
  if (!out) throw std::runtime_error(arguments.out + ": cannot be written; is the disk full?");
  for (const std::string& problem : sightings.problems) std::printf("not used: %s\n", problem.c_str());
  print_verdict(verdict, arguments.out);
  return 0;
}

}  // namespace

RunCommand add_calibrate(CLI::App& app) {
  struct State {
    CalibrateArguments arguments;
    OptionTable table;
  };
  auto state = std::make_shared<State>();
  add_options(state->table, state->arguments);
  state->table.attach(app);
  app.footer(
      "Examples: flogmap calibrate --left 'left*.png' --right 'right*.png' --board 9x6 --square-mm 25 --out "
      "calib.yaml\n"
      "          flogmap calibrate --source libcamera:LEFT,RIGHT --serve --board 9x6 --square-mm 25 --out "
      "calib.yaml");
  return [state] {
    state->table.apply(all_option_names());
    return calibrate(state->arguments);
  };
}

}  // namespace flogmap
