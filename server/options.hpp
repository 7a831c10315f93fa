#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "camera/source_spec.hpp"
#include "mapping/flog/flog_options.hpp"
#include "mapping/front_end.hpp"
#include "server/log.hpp"
#include "server/option_table.hpp"
#include "server/serve_options.hpp"

namespace flogmap {

/// All that a user can choose, with its defaults; filled by an OptionTable, checked once, passed down in
/// parts.
struct Options {
  SourceOptions source;
  FrontEndOptions front_end;
  FlogOptions flog;
  ServeOptions serve;
  LogOptions log;

  std::string poses_file;                    // map with these poses instead of odometry
  PosesFrame poses_frame = PosesFrame::raw;  // what --poses and --first-pose are poses of
  std::optional<SE3> first_pose;             // world_from_<poses_frame>
  bool as_fast_as_possible = false;          // --pace fast
  bool loop_closure = true;
  std::string tokens_file;   // serve: who may view, who may control
  std::string store;         // serve: the map's file
  std::string maps_dir;      // serve: stored maps beside the live one
  std::string out_dir;       // map: where the files go
  int map_memory_mb = 0;     // of the map's cells, about; 0 = all of them
  int view_memory_mb = 400;  // of packed views, from which the map is built anew
  int num_threads = 0;       // of each stage that can use several; 0 = every core
};

void add_source_options(OptionTable& table, Options& options);
/// A part of the source's, and of other commands that draw lots.
void add_seed_option(OptionTable& table, std::uint64_t& seed, const std::string& help);
void add_stereo_options(OptionTable& table, StereoOptions& stereo);
void add_mapping_options(OptionTable& table, Options& options);
/// Of every command that serves; add_serve_options() takes them in.
void add_listen_options(OptionTable& table, Options& options);
void add_serve_options(OptionTable& table, Options& options);

/// Names of every option of every command: a config file may serve several.
std::vector<std::string> all_option_names();

/// Passes --threads, --cell-size and --paper-mode on to the parts that share them, and checks each part.
/// Throws UsageError naming option, value and what is allowed.
void settle(Options& options);

}  // namespace flogmap
