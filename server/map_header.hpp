#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "camera/stereo_camera.hpp"
#include "mapping/flog/map_value.hpp"
#include "mapping/tile_update.hpp"
#include "server/tile_key.hpp"

namespace flogmap {

/// What a client must know of a map before its tiles mean anything.
struct MapHeader {
  std::string epoch;           // random name; revisions of two epochs cannot be compared
  std::uint64_t revision = 0;  // one number per committed map change
  MapInfo info;
  Operators operators = Operators::algebraic;
  std::optional<Bounds> bounds;  // of the tiles that exist; nothing while the map is empty
  StereoCamera camera;           // rectified left camera
};

/// Name of a layer for people: its heights, "0.05-0.75 m".
std::string layer_name(const GridSpec& grid, int layer);

}  // namespace flogmap
