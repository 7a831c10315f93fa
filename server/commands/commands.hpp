// One function per subcommand: tells the command line what it takes, and returns what to do once it is
// parsed.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace flogmap {

/// Runs the command; returns the exit code: 0 done, 1 failed while running, 2 bad usage or input. May throw
/// UsageError (2) or any other std::exception (1); main() prints them in one line.
using RunCommand = std::function<int()>;

RunCommand add_serve(CLI::App& app);
RunCommand add_map(CLI::App& app);
RunCommand add_disparity(CLI::App& app);
RunCommand add_evaluate(CLI::App& app);
RunCommand add_export(CLI::App& app);
RunCommand add_simulate(CLI::App& app);
RunCommand add_record(CLI::App& app);
RunCommand add_merge(CLI::App& app);
RunCommand add_calibrate(CLI::App& app);
RunCommand add_calib(CLI::App& app);
RunCommand add_cameras(CLI::App& app);

}  // namespace flogmap
