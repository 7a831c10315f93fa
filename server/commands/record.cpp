// flogmap record: writes what a source delivers as a recording, calibration included.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "camera/recording_writer.hpp"
#include "server/commands/commands.hpp"
#include "server/commands/interrupt_watcher.hpp"
#include "server/commands/progress_bar.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

constexpr double kNsPerSecond = 1e9;

struct RecordArguments {
  Options options;
  double duration_s = 0;  // 0: until the source ends or Ctrl-C
};

std::unique_ptr<StereoSource> open_input(const SourceOptions& options) {
  if (options.spec.empty()) throw UsageError("--source is missing; for instance --source sim:room");
  try {
    return open_source(options);
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

RecordingWriter open_output(const std::string& folder, const StereoSource& source) {
  if (folder.empty()) throw UsageError("--out is missing; for instance --out /tmp/recording");
  const auto calibration = source.calibration();
  if (!calibration) {
    throw UsageError(source.info().spec + ": carries no calibration; give one with --calibration FILE");
  }
  try {
    return {folder, *calibration, RecordingWriter::Options{}};
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

int record(const RecordArguments& arguments) {
  const auto source = open_input(arguments.options.source);
  const SourceInfo info = source->info();
  if (info.endless && arguments.duration_s <= 0) {
    throw UsageError(info.spec + ": has no end; say how long with --duration SECONDS");
  }
  RecordingWriter writer = open_output(arguments.options.out_dir, *source);
  const InterruptWatcher ctrl_c([&] { source->stop(); });
  ProgressBar progress("recording", info.num_frames.value_or(0));
  std::optional<std::int64_t> first_ns;
  while (const auto frame = source->next()) {
    if (!first_ns) first_ns = frame->timestamp_ns;
    const double seconds = static_cast<double>(frame->timestamp_ns - *first_ns) / kNsPerSecond;
    if (arguments.duration_s > 0 && seconds >= arguments.duration_s) break;
    writer.write(*frame, source->true_pose(frame->timestamp_ns));
    progress.show(writer.num_written(), "");
  }
  progress.finish();
  const SkippedFrames skipped = source->skipped();
  std::printf("%lld pairs written to %s; %lld skipped\n", static_cast<long long>(writer.num_written()),
              arguments.options.out_dir.c_str(), static_cast<long long>(skipped.count));
  if (skipped.count > 0) std::printf("warning: last skipped: %s\n", skipped.last_reason.c_str());
  return 0;
}

}  // namespace

RunCommand add_record(CLI::App& app) {
  struct State {
    RecordArguments arguments;
    OptionTable table;
  };
  auto state = std::make_shared<State>();
  add_source_options(state->table, state->arguments.options);
  state->table.text("out", "DIR", state->arguments.options.out_dir, "folder of the new recording");
  state->table.number("duration", "SECONDS", state->arguments.duration_s, 0, 1e9,
                      "stop after so long; 0 = until the source ends or Ctrl-C");
  state->table.attach(app);
  app.footer("Example: flogmap record --source sim:room --duration 10 --out /tmp/recording");
  return [state] {
    state->table.apply(all_option_names());
    return record(state->arguments);
  };
}

}  // namespace flogmap
