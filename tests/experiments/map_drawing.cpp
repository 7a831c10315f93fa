#include "tests/experiments/map_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "camera/picture_files.hpp"

namespace flogmap::experiments {
namespace {

MapArea cells_of(const GridSpec& grid, const WorldArea& area) {
  return {cell_at(grid, area.min_x_m, area.min_y_m), cell_at(grid, area.max_x_m, area.max_y_m)};
}

}  // namespace

GreyImage visual_map(const MapSnapshot& map, const WorldArea& area, std::optional<int> layer,
                     bool full_confidence) {
  MapSnapshot shown = map;
  if (full_confidence) {
    std::fill(shown.info.full_confidence_rays.begin(), shown.info.full_confidence_rays.end(), 1.0F);
  }
  return map_picture(shown, cells_of(map.info.grid, area), layer, {}).grey;
}

GreyImage trinary_map(const MapSnapshot& map, const WorldArea& area, std::optional<int> layer) {
  return trinary_picture(map, cells_of(map.info.grid, area), layer, {}).grey;
}

GreyImage true_map(const TruthLayer& truth, const WorldArea& area) {
  const double a = truth.cell_size_m;
  const auto column = [&](double x_m) { return static_cast<int>(std::floor((x_m - truth.origin_x_m) / a)); };
  const auto row = [&](double y_m) { return static_cast<int>(std::floor((y_m - truth.origin_y_m) / a)); };
  const int left = column(area.min_x_m), top = row(area.max_y_m) - 1;
  GreyImage image(column(area.max_x_m) - left, row(area.max_y_m) - row(area.min_y_m), 255);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!truth.solid.contains(left + x, top - y)) continue;
      image.at(x, y) = truth.solid.at(left + x, top - y) != 0 ? 0 : 255;
    }
  }
  return image;
}

void write_beside(const std::filesystem::path& file, const std::vector<GreyImage>& images, int zoom) {
  constexpr int kGap = 6;
  int width = -kGap, height = 0;
  for (const GreyImage& image : images) {
    width += image.width * zoom + kGap;
    height = std::max(height, image.height * zoom);
  }
  Picture sheet{width, height, 1, 8,
                std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height), 160)};
  int left = 0;
  for (const GreyImage& image : images) {
    for (int y = 0; y < image.height * zoom; ++y) {
      for (int x = 0; x < image.width * zoom; ++x) {
        sheet.bytes[std::size_t(y) * std::size_t(width) + std::size_t(left + x)] =
            image.at(x / zoom, y / zoom);
      }
    }
    left += image.width * zoom + kGap;
  }
  if (!write_picture(file, sheet)) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace flogmap::experiments
