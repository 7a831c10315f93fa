// A tile's cells as the bytes of the wire: round(255 * value), row-major, row 0 at the lowest y.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/flog/map_value.hpp"
#include "mapping/tile_update.hpp"

namespace flogmap {

/// 4096 bytes a plane.
using PlaneBytes = std::vector<std::uint8_t>;

/// E, O and K of one layer, one plane after the other.
PlaneBytes evidence_planes(const Tile& tile, int layer, float full_confidence_rays);

/// M of one layer, eq. (11).
PlaneBytes value_plane(const Tile& tile, int layer, float full_confidence_rays, Operators operators);

/// How much each cell changed lately; empty where none did.
PlaneBytes change_plane(const Tile& tile, int layer);

/// zlib format (RFC 1950).
std::string deflate_planes(const PlaneBytes& planes);

/// Inverse of deflate_planes(); nothing comes back (empty) if the bytes are damaged or not `size` long.
PlaneBytes inflate_planes(std::string_view deflated, std::size_t size);

}  // namespace flogmap
