// A tile as bytes by the rules of the day. FLOG.md section 5; the page has a twin of these rules.
#pragma once

#include <cstdint>
#include <optional>

#include "camera/image.hpp"
#include "mapping/flog/map_rules.hpp"
#include "mapping/tile_update.hpp"

namespace flogmap {

/// 64 x 64 bytes, row 0 at the lowest y.
using TilePlane = Image<std::uint8_t>;

inline constexpr std::uint8_t kTrinaryOccupied = 0;  // as in the pictures of ROS' map_server
inline constexpr std::uint8_t kTrinaryUnknown = 205;
inline constexpr std::uint8_t kTrinaryFree = 254;

/// round(255 * value) of every column of one layer, or, without a layer, the largest over all layers that the
/// rules' heights meet (0 if none does).
TilePlane value_plane(const Tile& tile, const MapInfo& info, std::optional<int> layer, const Rules& rules);

/// Occupied, free or unknown. Over several layers: occupied if one of them is, else unknown if one of them
/// is, so that free means free at all heights asked for. The rules' style does not matter.
TilePlane trinary_plane(const Tile& tile, const MapInfo& info, std::optional<int> layer, const Rules& rules);

/// What an unseen column looks like: the value of value_plane for a tile without rays.
std::uint8_t unseen_value(const MapInfo& info, const Rules& rules);

}  // namespace flogmap
