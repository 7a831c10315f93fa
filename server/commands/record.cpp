// flogmap record: writes what a source delivers as a recording, calibration included.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "camera/recording_writer.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/interrupt_watcher.hpp"
#include "server/commands/output_path.hpp"
#include "server/commands/progress_bar.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

constexpr double kNsPerSecond = 1e9;

enum class PictureFormat : std::uint8_t { png, pgm, jpg };

struct RecordArguments {
  Options options;
  OptionTable table;
  double duration_s = 0;  // 0: until the source ends or Ctrl-C
  PictureFormat pictures = PictureFormat::png;
};

std::unique_ptr<StereoSource> open_input(const SourceOptions& options) {
  if (options.spec.empty()) throw UsageError("--source is missing; for instance --source sim:room");
  try {
    return open_source(options);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

/// recording.json: what a reader of the folder may want to know later.
std::string about(const RecordArguments& arguments) {
  const nlohmann::json document = {{"recorded_by", "flogmap " FLOGMAP_VERSION},
                                   {"options", arguments.table.effective()},
                                   {"capture.csv", "of live cameras: skew, exposure and gain of each pair"}};
  return document.dump(2);
}

RecordingWriter open_output(const RecordArguments& arguments, const StereoSource& source) {
  const std::string& folder = arguments.options.out_dir;
  if (folder.empty()) throw UsageError("--out is missing; for instance --out /tmp/recording");
  const auto calibration = source.calibration();
  if (!calibration) {
    throw UsageError(source.info().spec + ": carries no calibration; give one with --calibration FILE");
  }
  make_output_folder(folder);
  try {
    return {folder, *calibration,
            RecordingWriter::Options{.compress = arguments.pictures != PictureFormat::pgm,
                                     .lossy = arguments.pictures == PictureFormat::jpg,
                                     .rate_hz = 0,
                                     .up_in_left_camera = source.up_in_left_camera(),
                                     .about = about(arguments)}};
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

int record(const RecordArguments& arguments) {
  const auto source = open_input(arguments.options.source);
  const SourceInfo info = source->info();
  RecordingWriter writer = open_output(arguments, *source);
  const InterruptWatcher ctrl_c([&] { source->stop(); });
  ProgressBar progress("recording", info.num_frames.value_or(0));
  std::optional<std::int64_t> first_ns;
  std::string broken_off;
  while (const auto frame = source->next()) {
    if (!first_ns) first_ns = frame->timestamp_ns;
    const double seconds = static_cast<double>(frame->timestamp_ns - *first_ns) / kNsPerSecond;
    if (arguments.duration_s > 0 && seconds >= arguments.duration_s) break;
    try {
      writer.write(*frame, source->true_pose(frame->timestamp_ns));
    } catch (const std::exception& error) {  // a full disk: what is there stays a recording
      broken_off = error.what();
      break;
    }
    progress.show(writer.num_written(), "");
  }
  progress.finish();
  const SkippedFrames skipped = source->skipped();
  std::printf("%lld pairs written to %s; %lld skipped\n", static_cast<long long>(writer.num_written()),
              arguments.options.out_dir.c_str(), static_cast<long long>(skipped.count));
  if (skipped.count > 0) std::fprintf(stderr, "warning: last skipped: %s\n", skipped.last_reason.c_str());
  if (!info.assumed.empty()) std::fprintf(stderr, "warning: %s\n", info.assumed.c_str());
  if (!broken_off.empty()) throw std::runtime_error(broken_off);
  return 0;
}

}  // namespace

RunCommand add_record(CLI::App& app) {
  auto state = std::make_shared<RecordArguments>();
  add_source_options(state->table, state->options);
  state->table.text("out", "DIR", state->options.out_dir, "folder of the new recording");
  state->table.number("duration", "SECONDS", state->duration_s, 0, 1e9,
                      "stop after so long; 0 = until the source ends or Ctrl-C");
  state->table.choice<PictureFormat>(
      "pictures", state->pictures,
      {{"png", PictureFormat::png}, {"pgm", PictureFormat::pgm}, {"jpg", PictureFormat::jpg}},
      "png: exact; pgm: exact, larger, several times faster; jpg: small, not exact");
  state->table.attach(app);
  app.footer("Example: flogmap record --source sim:room --duration 10 --out /tmp/recording");
  return [state] {
    state->table.apply(all_option_names());
    return record(*state);
  };
}

}  // namespace flogmap
