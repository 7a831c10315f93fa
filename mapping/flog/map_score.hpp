// How right a map is, compared with the truth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "camera/image.hpp"
#include "mapping/flog/map_value.hpp"
#include "mapping/tile_update.hpp"

namespace flogmap {

/// What is really there in one layer: pixel (x, y) is not 0 where a solid overlaps the cell's box. Row 0 at
/// the lowest y; the origin is the outer corner of pixel (0, 0).
struct TruthLayer {
  Image<std::uint8_t> solid;
  double origin_x_m = 0;
  double origin_y_m = 0;
  double cell_size_m = 0.02;
};

struct ScoreOptions {
  int tolerance_cells = 2;  // a surface may be this far off, cells of the truth
  Operators operators = Operators::algebraic;
  std::vector<Eigen::Vector2d> path_m;  // where the camera was: only free space connected to it counts;
                                        // empty: all of it
  // Of the truth's size, not 0 where the camera could see a surface at this layer's heights. Only true
  // surfaces near those count as seen; without it, those near anything that the map has seen.
  std::optional<Image<std::uint8_t>> seen_surfaces;
};

/// Shares in [0, 1]; 0 where there is nothing to count.
struct ClassScore {
  double precision = 0;
  double recall = 0;
  double f1 = 0;
};

struct LayerScore {
  ClassScore occupied;  // precision: cells called occupied near a true solid; recall: true surfaces that
                        // could be seen near a cell called occupied
  ClassScore free;      // precision: cells called free that are, or are near, truly free ones; recall: truly
                        // free seen cells called free
  double coverage = 0;  // truly free cells, connected to the path, that the map calls free
  double wrongly_blocked = 0;  // truly free seen cells called occupied though no solid is near
  double wrongly_free = 0;     // true surfaces seen that are called free with nothing occupied near
};

LayerScore score_layer(const MapSnapshot& map, int layer, const TruthLayer& truth,
                       const ScoreOptions& options);

}  // namespace flogmap
