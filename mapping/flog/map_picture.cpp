#include "mapping/flog/map_picture.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mapping/flog/map_planes.hpp"

namespace flogmap {
namespace {

MapArea grown(const MapArea& area, int margin) {
  return {{area.low.x - margin, area.low.y - margin}, {area.high.x + margin, area.high.y + margin}};
}

void require_drawable(const MapArea& area) {
  if (area.width() <= kMaxPicturePixels && area.width() * area.height() <= kMaxPicturePixels) return;
  throw std::length_error("a picture of " + std::to_string(area.width()) + " x " +
                          std::to_string(area.height()) + " cells is too large");
}

/// Fills an image of an area, row 0 at the highest y, from planes of its tiles.
template <typename PlaneOf>
Image<std::uint8_t> collect(const MapSnapshot& map, const MapArea& area, std::uint8_t unseen,
                            const PlaneOf& plane_of) {
  if (area.empty()) return {};
  require_drawable(area);
  Image<std::uint8_t> image(static_cast<int>(area.width()), static_cast<int>(area.height()), unseen);
  for (const auto& [index, tile] : map.tiles) {
    const CellIndex first = first_cell(index);
    const int x0 = std::max(area.low.x, first.x), x1 = std::min(area.high.x, first.x + kTileSide);
    const int y0 = std::max(area.low.y, first.y), y1 = std::min(area.high.y, first.y + kTileSide);
    if (x0 >= x1 || y0 >= y1) continue;
    const TilePlane plane = plane_of(*tile);
    for (int y = y0; y < y1; ++y) {
      const std::uint8_t* from = plane.row(y - first.y) + (x0 - first.x);
      std::copy(from, from + (x1 - x0), image.row(area.high.y - 1 - y) + (x0 - area.low.x));
    }
  }
  return image;
}

/// An image of `drawn` as a part of one of `area`; all else of it has the value `unseen`.
Image<std::uint8_t> framed(Image<std::uint8_t> image, const MapArea& drawn, const MapArea& area,
                           std::uint8_t unseen) {
  if (drawn == area) return image;
  Image<std::uint8_t> frame(static_cast<int>(area.width()), static_cast<int>(area.height()), unseen);
  for (int y = 0; y < image.height; ++y) {
    std::copy(image.row(y), image.row(y) + image.width,
              frame.row(area.high.y - drawn.high.y + y) + (drawn.low.x - area.low.x));
  }
  return frame;
}

Image<std::uint8_t> cropped(const Image<std::uint8_t>& image, int margin) {
  Image<std::uint8_t> inner(image.width - 2 * margin, image.height - 2 * margin);
  for (int y = 0; y < inner.height; ++y) {
    const std::uint8_t* from = image.row(y + margin) + margin;
    std::copy(from, from + inner.width, inner.row(y));
  }
  return inner;
}

/// Grows each row's values by `reach` pixels to both sides and takes the larger with what `target` has.
void spread_row(const std::uint8_t* row, int width, int reach, std::vector<std::uint8_t>& padded,
                std::vector<std::uint8_t>& widest) {
  padded.assign(std::size_t(width) + 2 * std::size_t(reach), 0);
  std::copy(row, row + width, padded.begin() + reach);
  // Doubling: after each round every value is the largest of `span` neighbours.
  int span = 1;
  const int wanted = 2 * reach + 1;
  while (span < wanted) {
    const int shift = std::min(span, wanted - span);
    for (std::size_t i = 0; i + shift < padded.size(); ++i)
      padded[i] = std::max(padded[i], padded[i + shift]);
    span += shift;
  }
  widest.assign(padded.begin(), padded.begin() + width);
}

}  // namespace

Image<std::uint8_t> spread_largest(const Image<std::uint8_t>& image, double radius) {
  const int r = static_cast<int>(radius);
  if (r <= 0 || image.empty()) return image;
  Image<std::uint8_t> spread = image;
  std::vector<std::uint8_t> padded, widest;
  for (int dy = 0; dy <= r; ++dy) {
    const int reach = static_cast<int>(std::sqrt(radius * radius - double{1} * dy * dy));
    for (int y = 0; y < image.height; ++y) {
      spread_row(image.row(y), image.width, reach, padded, widest);
      for (const int to : {y - dy, y + dy}) {
        if (to < 0 || to >= image.height) continue;
        std::uint8_t* out = spread.row(to);
        for (int x = 0; x < image.width; ++x) out[x] = std::max(out[x], widest[x]);
      }
    }
  }
  return spread;
}

MapPicture map_picture(const MapSnapshot& map, const MapArea& area, std::optional<int> layer,
                       const Rules& rules) {
  const double radius = rules.robot_radius_m / map.info.grid.cell_size_m;
  const int margin = area.empty() ? 0 : static_cast<int>(radius);
  require_drawable(area);
  const std::uint8_t unseen = unseen_value(map.info, rules);
  const MapArea drawn = intersection(area, grown(tiled_area(map), margin));  // beyond it nothing is known
  Image<std::uint8_t> values;
  if (!drawn.empty()) {
    values = collect(map, grown(drawn, margin), unseen,
                     [&](const Tile& tile) { return value_plane(tile, map.info, layer, rules); });
    if (margin > 0) values = cropped(spread_largest(values, radius), margin);
  }
  values = framed(std::move(values), drawn, area, unseen);
  for (std::uint8_t& value : values.pixels) value = static_cast<std::uint8_t>(255 - value);
  return {std::move(values), area, map.info.grid.cell_size_m};
}

MapPicture trinary_picture(const MapSnapshot& map, const MapArea& area, std::optional<int> layer,
                           const Rules& rules) {
  const double radius = rules.robot_radius_m / map.info.grid.cell_size_m;
  const int margin = area.empty() ? 0 : static_cast<int>(radius);
  const auto plane_of = [&](const Tile& tile) { return trinary_plane(tile, map.info, layer, rules); };
  Image<std::uint8_t> classes = collect(map, grown(area, margin), kTrinaryUnknown, plane_of);
  if (margin > 0) {
    Image<std::uint8_t> obstacles = classes;
    for (std::uint8_t& pixel : obstacles.pixels) pixel = pixel == kTrinaryOccupied ? 1 : 0;
    obstacles = spread_largest(obstacles, radius);
    for (std::size_t i = 0; i < classes.size(); ++i) {
      if (obstacles.pixels[i] != 0) classes.pixels[i] = kTrinaryOccupied;
    }
    classes = cropped(classes, margin);
  }
  return {std::move(classes), area, map.info.grid.cell_size_m};
}

}  // namespace flogmap
