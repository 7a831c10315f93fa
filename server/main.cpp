#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "server/command_line.hpp"
#include "server/commands/commands.hpp"
#include "server/option_table.hpp"

namespace {

struct Command {
  const char* name;
  const char* summary;
  flogmap::RunCommand (*add)(CLI::App& app);
};

constexpr Command kCommands[] = {
    {"serve", "map from cameras or a recording and show it in the browser", flogmap::add_serve},
    {"map", "map a recording as fast as possible and write the map's files", flogmap::add_map},
    {"disparity", "dense disparity of one pair of pictures", flogmap::add_disparity},
    {"evaluate", "compare a trajectory or a map with the truth", flogmap::add_evaluate},
    {"export", "write a stored map in another format", flogmap::add_export},
    {"merge", "make one map of two", flogmap::add_merge},
    {"simulate", "render a recording with exact ground truth", flogmap::add_simulate},
    {"record", "write what a source delivers as a recording", flogmap::add_record},
    {"calibrate", "stereo calibration from pictures of a board, with a verdict", flogmap::add_calibrate},
    {"calib", "check: does a calibration suit the pictures?", flogmap::add_calib},
    {"cameras", "list the cameras that libcamera sees", flogmap::add_cameras},
};

int complain(const std::string& message, int exit_code) {
  std::fprintf(stderr, "flogmap: %s\n", message.c_str());
  return exit_code;
}

int run(int argc, char** argv) {
  std::vector<std::string> names;
  for (const Command& command : kCommands) names.emplace_back(command.name);
  flogmap::check_first_word(argc > 1 ? argv[1] : "", names);
  CLI::App app("flogmap: two cameras in, a live map in any browser out.", "flogmap");
  app.set_version_flag("--version", "flogmap " FLOGMAP_VERSION);
  app.require_subcommand(1);
  app.footer("Try: flogmap serve --source sim:room     then open http://127.0.0.1:8080");
  std::vector<std::pair<CLI::App*, flogmap::RunCommand>> commands;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    commands.emplace_back(sub, command.add(*sub));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    return complain(flogmap::unexpected_words(app) + "; see flogmap COMMAND --help", 2);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return complain(std::string(error.what()) + "; see flogmap --help, flogmap COMMAND --help", 2);
  }
  for (const auto& [sub, command] : commands) {
    if (sub->parsed()) return command();
  }
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  // Whoever reads our lines may leave; that ends nobody's map.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    const int exit_code = run(argc, argv);
    if (flogmap::flush_output() || exit_code != 0) return exit_code;
    return complain("standard output cannot be written; is the disk full?", 1);
  } catch (const flogmap::UsageError& error) {
    return complain(error.what(), 2);
  } catch (const std::exception& error) {
    return complain(error.what(), 1);
  }
}
