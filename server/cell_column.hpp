#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flogmap {

/// One cell of one layer with its full precision and what the rules make of it; all but `rays` in [0, 1].
struct CellEvidence {
  int layer = 0;
  double empty = 0;
  double occupied = 0;
  double confidence = 0;
  std::uint32_t rays = 0;
  double value = 0;
  double planning = 0;
  double motion = 0;
  double conflict = 0;
  double change = 0;
};

/// All layers at one point of the world, metres.
struct CellColumn {
  double x_m = 0;
  double y_m = 0;
  std::string epoch;
  std::uint64_t revision = 0;  // of the tile; 0 where nothing was ever seen
  std::vector<CellEvidence> layers;
};

}  // namespace flogmap
