// The map, or a part of it, as one picture. FLOG.md section 5.
#pragma once

#include <cstdint>
#include <optional>

#include "camera/image.hpp"
#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_rules.hpp"
#include "mapping/tile_update.hpp"

namespace flogmap {

/// North-up: row 0 at the highest y. One pixel is one column of cells.
struct MapPicture {
  Image<std::uint8_t> grey;
  MapArea area;
  double cell_size_m = 0;

  /// World place of the outer corner of the picture's lower left pixel, metres.
  [[nodiscard]] double origin_x_m() const { return area.low.x * cell_size_m; }
  [[nodiscard]] double origin_y_m() const { return area.low.y * cell_size_m; }
  [[nodiscard]] int pixel_x(CellIndex cell) const { return cell.x - area.low.x; }
  [[nodiscard]] int pixel_y(CellIndex cell) const { return area.high.y - 1 - cell.y; }
};

/// A picture may have at most this many pixels.
inline constexpr std::int64_t kMaxPicturePixels = std::int64_t{1} << 28;

/// grey = 255 (1 - value), as in the paper: for the visual map white is free or unknown, black occupied. One
/// layer, or all that meet the rules' heights. Values are spread over the robot's radius if the rules have
/// one. Throws std::length_error beyond kMaxPicturePixels.
MapPicture map_picture(const MapSnapshot& map, const MapArea& area, std::optional<int> layer,
                       const Rules& rules);

/// 0 occupied, 254 free, 205 unknown; see trinary_plane(). Obstacles are spread over the robot's radius.
MapPicture trinary_picture(const MapSnapshot& map, const MapArea& area, std::optional<int> layer,
                           const Rules& rules);

/// Every pixel becomes the largest within `radius` pixels of it (between pixel middles).
Image<std::uint8_t> spread_largest(const Image<std::uint8_t>& image, double radius);

}  // namespace flogmap
