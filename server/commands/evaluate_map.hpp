#pragma once

#include <string>

namespace flogmap {

/// Scores the stored map of `map_file` against the truth images in `truth_folder` (layer_<k>.png + .json, and
/// seen_<k>.png where it exists) and prints a table or JSON. Throws UsageError naming the file that cannot be
/// used.
void evaluate_map(const std::string& map_file, const std::string& truth_folder, int tolerance_cells,
                  bool json);

}  // namespace flogmap
