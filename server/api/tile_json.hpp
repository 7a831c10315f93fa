#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "server/tile_board.hpp"

namespace flogmap {

/// A tile for programs without Protobuf: bytes 0 .. 255 of E, O, K and M of these layers (rising; empty:
/// all), 4096 numbers a plane, row 0 at the lowest y.
nlohmann::ordered_json tile_json(TileBoard& board, Slot slot, const std::vector<int>& layers);

}  // namespace flogmap
