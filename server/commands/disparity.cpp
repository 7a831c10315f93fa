// flogmap disparity: one pair of pictures in, the disparity of the left one out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/detect.hpp"
#include "camera/low_bits.hpp"
#include "camera/picture_files.hpp"
#include "camera/recording_writer.hpp"
#include "camera/rectifier.hpp"
#include "mapping/stereo/disparity_matcher.hpp"
#include "mapping/stereo/row_offset.hpp"
#include "mapping/stereo/segment_filter.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/output_path.hpp"
#include "server/options.hpp"
#include "server/picture_encoding.hpp"

namespace flogmap {
namespace {

constexpr double kThinPercent = 25;      // fewer matches than this and something is wrong with the pair
constexpr int kDefaultDisparities = 64;  // where no calibration tells how near things can be

struct DisparityArguments {
  std::string left, right, out;
  std::string calibration;
  StereoOptions stereo;
};

Picture read_input(const std::string& file) {
  ReadPicture read = read_picture(file);
  if (!read.problem.empty()) throw UsageError(read.problem);
  return std::move(read.picture);
}

/// Without a calibration the pair is taken as rectified already; then only the size of the camera matters.
StereoCalibration calibration_for(const DisparityArguments& arguments, const Picture& left) {
  StereoCalibration calibration;
  if (!arguments.calibration.empty()) {
    calibration = read_calibration(arguments.calibration);
    fit_resolution(calibration, left.width, left.height, arguments.left);
    return calibration;
  }
  CameraIntrinsics& camera = calibration.left;
  camera.width_px = left.width;
  camera.height_px = left.height;
  camera.fx_px = camera.fy_px = left.width;
  camera.cx_px = left.width / 2.0;
  camera.cy_px = left.height / 2.0;
  calibration.right = calibration.left;
  calibration.right_from_left.translation().x() = -0.1;
  calibration.rectified = true;
  calibration.origin = arguments.left;
  return calibration;
}

/// A calibration that cannot be used is bad input.
Rectifier rectifier_for(const DisparityArguments& arguments, const Picture& left) {
  try {
    return Rectifier(calibration_for(arguments, left));
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

/// Portable float map: +inf where there is no match.
void write_disparity(const std::string& file, Image<float> disparity) {
  for (float& d : disparity.pixels) {
    if (std::isnan(d)) d = std::numeric_limits<float>::infinity();
  }
  write_pfm(file, disparity);
}

/// The disparity in colours, as the page shows it.
void write_picture_of(const DisparityImage& disparity, const std::string& file) {
  const PictureReport report{0, nullptr, std::make_shared<DisparityImage>(disparity)};
  const std::optional<EncodedPicture> picture = encode_picture(report, {ImageStream::disparity, 0});
  if (!picture) throw std::runtime_error(file + ": the disparity has no picture");
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << picture->data;
  out.close();
  if (!out) throw std::runtime_error(file + ": cannot be written; is the disk full?");
}

std::string beside(const std::string& pfm) {
  const std::size_t dot = pfm.rfind('.');
  const bool has_extension = dot != std::string::npos && pfm.find('/', dot) == std::string::npos;
  return (has_extension ? pfm.substr(0, dot) : pfm) + ".png";
}

void check_output(const std::string& pfm) {
  if (pfm.empty()) throw UsageError("--out is missing; for instance --out D.pfm");
  const std::string png = beside(pfm);
  if (png == pfm)
    throw UsageError("--out " + pfm +
                     ": must not end in .png, which is the picture beside it; for instance D.pfm");
  const std::filesystem::path folder = std::filesystem::path(pfm).parent_path();
  if (!folder.empty()) make_output_folder(folder);
  for (const std::string& file : {pfm, png}) check_output_file(file);
}

double density_percent(const Image<float>& disparity) {
  std::size_t valid = 0;
  for (const float d : disparity.pixels) valid += std::isnan(d) ? 0 : 1;
  return 100.0 * static_cast<double>(valid) / static_cast<double>(disparity.size());
}

/// A pair that is not rectified gives a thin, wrong disparity; better say so than leave the user to wonder.
void warn_of_row_offset(const RectifiedFrame& pair, const DisparityArguments& arguments) {
  const StereoOptions& stereo = arguments.stereo;
  const int num_disparities = stereo.num_disparities > 0 ? stereo.num_disparities : kDefaultDisparities;
  const auto offset = measure_row_offset(pair, stereo.min_disparity, num_disparities);
  if (!offset || std::abs(offset->median_px) <= kTolerableRowOffset_px) return;
  std::fprintf(stderr, "warning: rows of %s lie %.1f px %s than those of %s; %s\n", arguments.right.c_str(),
               std::abs(offset->median_px), offset->median_px > 0 ? "lower" : "higher",
               arguments.left.c_str(),
               arguments.calibration.empty() ? "is the pair rectified? If not, name its --calibration"
                                             : "the calibration does not fit these cameras: calibrate again");
}

int compute(DisparityArguments arguments) {
  check_output(arguments.out);
  StereoFrame frame{
      .timestamp_ns = 0, .left = read_input(arguments.left), .right = read_input(arguments.right)};
  if (frame.left.width != frame.right.width || frame.left.height != frame.right.height) {
    throw UsageError(arguments.right + ": is " + std::to_string(frame.right.width) + "x" +
                     std::to_string(frame.right.height) + ", but " + arguments.left + " is " +
                     std::to_string(frame.left.width) + "x" + std::to_string(frame.left.height));
  }
  const int unused = std::min(unused_bits(frame.left), unused_bits(frame.right));
  for (Picture* picture : {&frame.left, &frame.right}) shift_up(*picture, unused);
  const Rectifier rectifier = rectifier_for(arguments, frame.left);
  const bool know_nearest = !arguments.calibration.empty();
  if (arguments.stereo.num_disparities == 0 && !know_nearest)
    arguments.stereo.num_disparities = kDefaultDisparities;
  const RectifiedFrame rectified = rectifier.rectify(frame);
  warn_of_row_offset(rectified, arguments);
  const auto matcher = make_matcher(arguments.stereo, rectifier.camera());
  const auto start = std::chrono::steady_clock::now();
  DisparityImage disparity = matcher->match(rectified);
  remove_small_segments(disparity, min_segment_px(arguments.stereo, rectifier.camera()));
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  write_disparity(arguments.out, disparity.px);
  const std::string png = beside(arguments.out);
  write_picture_of(disparity, png);
  std::printf("%dx%d, density %.1f %%, %.1f ms; written: %s, %s\n", disparity.px.width, disparity.px.height,
              density_percent(disparity.px), ms, arguments.out.c_str(), png.c_str());
  if (density_percent(disparity.px) < kThinPercent) {
    std::fprintf(stderr, "warning: few pixels found a match. %s, and is %s really the left picture?\n",
                 arguments.calibration.empty() ? "Is the pair rectified? If not, name its --calibration"
                                               : "Does the calibration belong to these cameras",
                 arguments.left.c_str());
  }
  return 0;
}

}  // namespace

RunCommand add_disparity(CLI::App& app) {
  struct State {
    DisparityArguments arguments;
    OptionTable table;
  };
  auto state = std::make_shared<State>();
  DisparityArguments& arguments = state->arguments;
  app.add_option("left", arguments.left, "left picture")->required()->type_name("LEFT");
  app.add_option("right", arguments.right, "right picture")->required()->type_name("RIGHT");
  state->table.text("out", "D.pfm", arguments.out,
                    "PFM, float disparities, +inf where there is none; also a PNG");
  state->table.text("calibration", "FILE", arguments.calibration,
                    "rectify first; otherwise the pair is rectified");
  add_stereo_options(state->table, arguments.stereo);
  state->table.attach(app);
  app.footer("Example: flogmap disparity left.png right.png --out D.pfm --num-disparities 128");
  return [state] {
    state->table.apply(all_option_names());
    return compute(state->arguments);
  };
}

}  // namespace flogmap
