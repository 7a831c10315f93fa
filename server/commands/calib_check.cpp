// flogmap calib check: does this calibration suit these pictures?
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "camera/calibration/calibration_review.hpp"
#include "camera/calibration/distortion.hpp"
#include "camera/rectifier.hpp"
#include "server/commands/commands.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

constexpr int kPairs = 8;

std::unique_ptr<StereoSource> open_input(const SourceOptions& options) {
  if (options.spec.empty()) throw UsageError("--source is missing; for instance --source euroc:DIR");
  try {
    return open_source(options);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

/// Pairs spread over a recording; of a camera, the first ones.
std::vector<StereoFrame> some_pairs(StereoSource& source) {
  const SourceInfo info = source.info();
  const bool spread = !info.live && !info.endless && info.num_frames.value_or(0) > kPairs;
  const std::int64_t step_ns = (info.last_timestamp_ns - info.first_timestamp_ns) / kPairs;
  std::vector<StereoFrame> frames;
  for (int i = 0; i < kPairs; ++i) {
    if (spread && i > 0) source.seek(info.first_timestamp_ns + i * step_ns);
    std::optional<StereoFrame> frame = source.next();
    if (!frame) break;
    frames.push_back(std::move(*frame));
  }
  return frames;
}

void print(const StereoCalibration& calibration, const CalibrationReview& review,
           const StereoSource& source) {
  std::printf("dialect          %s (%s)\n", calibration.dialect.c_str(), calibration.origin.c_str());
  std::printf("lenses           %s\n", name_of(calibration.left.distortion));
  std::printf("resolution       %dx%d\n", calibration.left.width_px, calibration.left.height_px);
  std::printf("baseline         %.2f mm\n", 1000 * calibration.right_from_left.translation().norm());
  std::printf("matches          %zu corners, %.0f %% on the same row\n", review.num_matches,
              100 * review.agreeing_share);
  std::printf("rows differ by   %.2f px (median), %.2f px (p95), right %+.2f px lower\n",
              review.vertical_p50_px, review.vertical_p95_px, review.vertical_bias_px);
  const std::optional<PairSkew> skew = source.skew();
  if (skew && skew->histogram.total() > 0) {
    std::printf("time skew        %.3f ms (mean), %.3f ms (largest)\n", skew->histogram.mean_ms(),
                skew->histogram.largest_ms);
  } else {
    std::printf("time skew        not known: the source has one time per pair\n");
  }
  const SkippedFrames skipped = source.skipped();
  if (skipped.count > 0)
    std::printf("skipped          %lld; last: %s\n", static_cast<long long>(skipped.count),
                skipped.last_reason.c_str());
  for (const std::string& fault : review.faults) std::printf("fault: %s\n", fault.c_str());
  std::printf("verdict          %s\n", review.faults.empty() ? "fits" : "does not fit");
}

int check_calibration(const SourceOptions& options) {
  const auto source = open_input(options);
  const auto calibration = source->calibration();
  if (!calibration)
    throw UsageError(options.spec + ": carries no calibration; give one with --calibration FILE");
  const CalibrationReview review = review_calibration(*calibration, some_pairs(*source));
  print(*calibration, review, *source);
  return review.faults.empty() ? 0 : 1;
}

}  // namespace

RunCommand add_calib(CLI::App& app) {
  struct State {
    Options options;
    OptionTable table;
  };
  auto state = std::make_shared<State>();
  CLI::App* check = app.add_subcommand("check", "dialect, rows, mix-ups and time skew of a calibration");
  add_source_options(state->table, state->options);
  state->table.attach(*check);
  check->footer("Example: flogmap calib check --source euroc:/data/MH_01 --calibration mine.yaml");
  return [state, check] {
    if (!check->parsed()) throw UsageError("calib: what to do is missing; allowed: check");
    state->table.apply(all_option_names());
    return check_calibration(state->options.source);
  };
}

}  // namespace flogmap
