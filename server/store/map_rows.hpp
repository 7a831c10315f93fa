// Poses as bytes, and the checksums of the rows of tiles, trajectory and views.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mapping/view.hpp"
#include "server/map_store.hpp"

namespace flogmap {

/// The upper three rows of the matrix, row by row: 12 doubles, 96 bytes.
std::vector<std::uint8_t> pose_bytes(const SE3& pose);
/// Nothing unless these are 96 bytes of finite numbers.
std::optional<SE3> pose_of(std::span<const std::uint8_t> bytes);

std::uint64_t tile_checksum(TileIndex index, std::uint64_t revision, std::span<const std::uint8_t> cells);
std::uint64_t pose_checksum(std::uint64_t number, const TrajectoryEntry& entry);
std::uint64_t view_checksum(const StoredView& view);

}  // namespace flogmap
