// What is truly there, from the files that `flogmap simulate` writes and anyone can write.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "camera/image.hpp"
#include "mapping/flog/map_score.hpp"

namespace flogmap {

/// One layer of a world: where solids are, and where the camera could see a surface, if that is known.
struct LayerTruth {
  TruthLayer solid;
  double low_m = 0, high_m = 0;                      // its heights; 0, 0 if the files do not say
  std::optional<Image<std::uint8_t>> seen_surfaces;  // of the same size
};

/// Reads layer_<k>.png (not 0 = solid, row 0 at the lowest y), layer_<k>.json (`origin` [x, y], `cell` and,
/// if there, `z` [low, high]; metres) and, if there is one, surface_<k>.png, else seen_<k>.png. Throws
/// std::runtime_error naming file, field and what is allowed.
[[nodiscard]] LayerTruth read_layer_truth(const std::filesystem::path& folder, int layer);

}  // namespace flogmap
