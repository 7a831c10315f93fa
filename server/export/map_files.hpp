#pragma once

#include <filesystem>

#include "mapping/flog/map_value.hpp"
#include "server/map_store.hpp"

namespace flogmap {

/// What `flogmap map` leaves of a map in a folder, which is made if missing: map.flog, trajectory.tum,
/// fused.png, layer_<k>.png, path.png and, for ROS, ros/map.pgm, ros/layer_<k>.pgm with their .yaml. All
/// pictures show the same window, north up. Throws std::runtime_error naming the file that cannot be written.
void write_map_folder(const std::filesystem::path& folder, const StoredMap& map,
                      Operators operators = Operators::algebraic);

}  // namespace flogmap
