// Parts of maps as pictures, side by side.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "camera/image.hpp"
#include "mapping/flog/map_picture.hpp"
#include "mapping/flog/map_score.hpp"
#include "mapping/tile_update.hpp"

namespace flogmap::experiments {

using GreyImage = Image<std::uint8_t>;  // row 0 at the highest y

/// A rectangle of the world, metres.
struct WorldArea {
  double min_x_m, min_y_m, max_x_m, max_y_m;
};

/// The visual map of one layer, or of all: white free or unknown, black occupied. With `full_confidence` the
/// confidence counts as 1, as it does for trinary maps.
[[nodiscard]] GreyImage visual_map(const MapSnapshot& map, const WorldArea& area, std::optional<int> layer,
                                   bool full_confidence = false);

/// Black occupied, white free, grey unknown.
[[nodiscard]] GreyImage trinary_map(const MapSnapshot& map, const WorldArea& area, std::optional<int> layer);

[[nodiscard]] GreyImage true_map(const TruthLayer& truth, const WorldArea& area);

/// Side by side with a gap, every pixel `zoom` pixels wide. Throws std::runtime_error naming the file.
void write_beside(const std::filesystem::path& file, const std::vector<GreyImage>& images, int zoom);

}  // namespace flogmap::experiments
