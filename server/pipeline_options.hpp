#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapping/loop/loop_closer.hpp"
#include "mapping/tile_update.hpp"
#include "mapping/view.hpp"
#include "server/publication.hpp"

namespace flogmap {

/// The map that the first frames continue; empty for a fresh one.
struct ContinuedMap {
  std::string epoch;
  std::vector<TileUpdate> tiles;
  std::vector<TrajectoryEntry> trajectory;
  std::vector<SharedView> views;
  HandLevel level;  // how a recording was levelled; what cameras see next is levelled already
};

struct PipelineOptions {
  double rate = 1;               // 1 as recorded, 0 as fast as possible
  bool loop = false;             // a recording starts again at its end
  bool end_with_source = false;  // batch: wait() returns when the recording has ended
  std::int64_t max_frames = 0;   // the source counts as ended after so many; 0 = never
  std::size_t statistics_window = 256;
  std::optional<LoopOptions> loop_closure;               // nothing: loops stay open
  bool keep_views = false;                               // even so, to be levelled by hand
  std::size_t max_view_bytes = std::size_t{400} << 20U;  // of views kept to build the map anew
  ContinuedMap continued;
};

}  // namespace flogmap
