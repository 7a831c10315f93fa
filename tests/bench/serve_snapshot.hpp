// A large map and one who comes to it: how long until it is all there, and what coming back costs.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/publication.hpp"

namespace flogmap {

/// A map of side x side tiles around the origin, at revision 1; three layers of made-up evidence.
MapBegin large_map(int side);

/// The tiles of that map's first rows as of another revision.
std::vector<TileUpdate> changed_tiles(const MapBegin& map, int count, std::uint64_t revision);

/// A new viewer that looks at 30 x 20 m: {viewport_tiles, viewport_s, everything_tiles, everything_s,
/// everything_mb}.
nlohmann::json arrive(std::uint16_t port);

/// A viewer that has the map as of a revision: {resume_tiles, resume_kib, resume_s}.
nlohmann::json come_back(std::uint16_t port, const std::string& epoch, std::uint64_t revision);

}  // namespace flogmap
