// GET /maps/{id}/image.png?bbox=&layer=&style=&palette=&width=
#include <algorithm>
#include <cmath>

#include "mapping/flog/map_picture.hpp"
#include "server/api/parameters.hpp"
#include "server/api/resources.hpp"
#include "server/picture_encoding.hpp"

namespace flogmap {
namespace {

constexpr std::int64_t kMaxPixels = 16'000'000;
constexpr std::int64_t kMaxCells = 4 * kMaxPixels;
constexpr std::int64_t kMaxSide = 65'535;

MapArea requested_area(const MapSnapshot& map, const std::optional<Bounds>& bbox) {
  if (!bbox) return tiled_area(map);
  const double a = map.info.grid.cell_size_m, most = 2e9 * a;
  const bool far = std::abs(bbox->x_min) > most || std::abs(bbox->y_min) > most ||
                   std::abs(bbox->x_max) > most || std::abs(bbox->y_max) > most;
  if (far) throw RefusedRequest(400, "bad-parameter", "no cell lies so far out", "bbox");
  // Cells that the box meets by more than a millionth: one that ends at a border stays on its side of it.
  const auto first = [a](double v) { return static_cast<int>(std::floor(v / a + 1e-6)); };
  const auto behind = [a](double v) { return static_cast<int>(std::ceil(v / a - 1e-6)); };
  const CellIndex low{first(bbox->x_min), first(bbox->y_min)};
  return {low, {std::max(low.x + 1, behind(bbox->x_max)), std::max(low.y + 1, behind(bbox->y_max))}};
}

/// As it will be sent.
PictureSize checked_size(const MapArea& area, int max_width_px) {
  const bool huge = area.width() > kMaxCells || area.height() > kMaxCells / area.width();
  const PictureSize size = fitted_size(area.width(), area.height(), max_width_px);
  if (!huge && size.width <= kMaxSide && size.height <= kMaxSide && size.width * size.height <= kMaxPixels) {
    return size;
  }
  throw RefusedRequest(422, "picture-too-large",
                       "at most 16 megapixels, 65,535 to a side, of 64 million cells; give bbox or width",
                       "width");
}

ApiResponse picture_of(const MapSnapshot& map, const MapArea& area, const PictureChoice& choice,
                       const Rules& rules, PictureSize size) {
  MapPicture picture = map_picture(map, area, choice.layer, rules);
  for (std::uint8_t& pixel : picture.grey.pixels)
    pixel = static_cast<std::uint8_t>(255 - pixel);  // back to values
  ApiResponse response;
  response.content_type = "image/png";
  response.body = to_shared(encode_coloured_png(shrunk_to_largest(picture.grey, size), choice.palette));
  response.headers.emplace_back(
      "Flogmap-Origin", std::to_string(picture.origin_x_m()) + "," + std::to_string(picture.origin_y_m()));
  const double pixel_m =
      picture.cell_size_m * static_cast<double>(area.width()) / static_cast<double>(size.width);
  response.headers.emplace_back("Flogmap-Cell-Size", std::to_string(pixel_m));
  return response;
}

ApiAnswer get_image(const ApiRequest& request, ServerState& state) {
  ServedMap& map = requested_map(request, state);
  const auto layer = parse_layer(request.parameter("layer").value_or("fused"), map.board().info());
  const PictureChoice choice = picture_choice(request, layer);
  const auto width = static_cast<int>(integer_parameter(request, "width", 0, 1, 16384));
  const std::string etag = etag_of(map, request, state.options);
  const auto snapshot = map.snapshot();
  const MapArea area = requested_area(*snapshot, bbox_parameter(request));
  if (area.empty()) {
    ApiResponse nothing;
    nothing.status = 204;
    return nothing;
  }
  const PictureSize size = checked_size(area, width);
  if (is_known(request, etag)) return nothing_new(etag);
  Rules rules;
  rules.style = choice.style;
  rules.operators = state.options.operators;
  const bool for_robot = choice.style == Style::planning || choice.style == Style::motion;
  if (for_robot) rules.robot_radius_m = state.options.robot.radius_m;
  if (for_robot && state.options.robot.height_m > 0) rules.heights = {0, state.options.robot.height_m};
  return ApiJob([=] {
    ApiResponse response = picture_of(*snapshot, area, choice, rules, size);
    response.etag = etag;
    response.cache_control = kLiveCache;
    return response;
  });
}

}  // namespace

std::vector<Route> image_routes() {
  return {{Method::get, "/api/v1/maps/{}/image.png", Role::view, get_image}};
}

}  // namespace flogmap
