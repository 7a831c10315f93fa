#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mapping/hand_level.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// A loop closed, or somebody levelled the map: where everything so far now is. The tiles follow later.
struct PathRewrite {
  std::uint64_t number = 0;           // counts the corrections of one run, from 1
  std::vector<TrajectoryEntry> path;  // the whole path so far, frames that had no place before included
  HandLevel level;                    // by hand, of this path
  std::string reason;                 // in words, for viewers
};

}  // namespace flogmap
