#pragma once

#include <string>

#include "mapping/flog/map_value.hpp"
#include "server/map_store.hpp"

namespace flogmap {

/// A binary OctoMap tree (.bt): every occupied or free cell as a column of cubes of the cell's side, from the
/// floor of its layer to its top; unknown cells stay unknown. Throws std::runtime_error if the map does not
/// fit the 2^16 cubes along an axis that an OctoMap tree has.
std::string octomap_of(const StoredMap& map, Operators operators);

}  // namespace flogmap
