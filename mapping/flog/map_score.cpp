#include "mapping/flog/map_score.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "mapping/flog/map_area.hpp"
#include "mapping/flog/map_picture.hpp"

namespace flogmap {
namespace {

using Mask = Image<std::uint8_t>;  // 0 or 1

/// The truth with a frame of nothing around it, wide enough for all that the map has seen.
TruthLayer framed(const TruthLayer& truth, const MapSnapshot& map) {
  const MapArea seen = seen_area(map);
  const double a = map.info.grid.cell_size_m, cell = truth.cell_size_m;
  const auto cells_beyond = [&](double by_m) {
    return std::clamp(static_cast<int>(std::ceil(by_m / cell)), 0, 10'000);
  };
  const int left = cells_beyond(truth.origin_x_m - seen.low.x * a);
  const int below = cells_beyond(truth.origin_y_m - seen.low.y * a);
  const int right = cells_beyond(seen.high.x * a - truth.origin_x_m - truth.solid.width * cell);
  const int above = cells_beyond(seen.high.y * a - truth.origin_y_m - truth.solid.height * cell);
  TruthLayer wide{Mask(truth.solid.width + left + right, truth.solid.height + below + above, 0),
                  truth.origin_x_m - left * cell, truth.origin_y_m - below * cell, cell};
  for (int y = 0; y < truth.solid.height; ++y) {
    for (int x = 0; x < truth.solid.width; ++x)
      wide.solid.at(x + left, y + below) = truth.solid.at(x, y) != 0 ? 1 : 0;
  }
  return wide;
}

Mask shifted_into(const TruthLayer& wide, const TruthLayer& truth, const Mask& mask) {
  const int left = static_cast<int>(std::lround((truth.origin_x_m - wide.origin_x_m) / wide.cell_size_m));
  const int below = static_cast<int>(std::lround((truth.origin_y_m - wide.origin_y_m) / wide.cell_size_m));
  Mask out(wide.solid.width, wide.solid.height, 0);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) out.at(x + left, y + below) = mask.at(x, y) != 0 ? 1 : 0;
  }
  return out;
}

/// Class of the map at the middle of every truth cell.
Image<CellClass> classes_of(const MapSnapshot& map, int layer, const TruthLayer& truth, Operators operators) {
  Image<CellClass> classes(truth.solid.width, truth.solid.height, CellClass::unknown);
  for (int y = 0; y < classes.height; ++y) {
    for (int x = 0; x < classes.width; ++x) {
      const CellIndex cell = cell_at(map.info.grid, truth.origin_x_m + (x + 0.5) * truth.cell_size_m,
                                     truth.origin_y_m + (y + 0.5) * truth.cell_size_m);
      classes.at(x, y) = classify(operators, cell_in(map, cell, layer), map.info.min_rays);
    }
  }
  return classes;
}

/// Free cells that a walk from the path can reach; all of them without a path.
Mask reachable_free(const TruthLayer& truth, const std::vector<Eigen::Vector2d>& path_m) {
  const Mask& solid = truth.solid;
  Mask free(solid.width, solid.height, 0);
  std::deque<std::pair<int, int>> open;
  const auto reach = [&](int x, int y) {
    if (!solid.contains(x, y) || solid.at(x, y) != 0 || free.at(x, y) != 0) return;
    free.at(x, y) = 1;
    open.emplace_back(x, y);
  };
  for (const Eigen::Vector2d& p : path_m) {
    reach(static_cast<int>(std::floor((p.x() - truth.origin_x_m) / truth.cell_size_m)),
          static_cast<int>(std::floor((p.y() - truth.origin_y_m) / truth.cell_size_m)));
  }
  if (path_m.empty())
    std::transform(solid.pixels.begin(), solid.pixels.end(), free.pixels.begin(),
                   [](auto s) { return s ? 0 : 1; });
  while (!open.empty()) {
    const auto [x, y] = open.front();
    open.pop_front();
    reach(x + 1, y), reach(x - 1, y), reach(x, y + 1), reach(x, y - 1);
  }
  return free;
}

template <typename Predicate>
Mask mask_of(const Mask& like, const Predicate& predicate) {
  Mask mask(like.width, like.height, 0);
  for (std::size_t i = 0; i < mask.size(); ++i) mask.pixels[i] = predicate(i) ? 1 : 0;
  return mask;
}

/// Share of the cells with `all` that also have `some`.
double share(const Mask& all, const Mask& some) {
  double counted = 0, hit = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    counted += all.pixels[i];
    hit += all.pixels[i] & some.pixels[i];
  }
  return counted > 0 ? hit / counted : 0;
}

ClassScore class_score(double precision, double recall) {
  const double sum = precision + recall;
  return {precision, recall, sum > 0 ? 2 * precision * recall / sum : 0};
}

}  // namespace

LayerScore score_layer(const MapSnapshot& map, int layer, const TruthLayer& truth,
                       const ScoreOptions& options) {
  const TruthLayer wide = framed(truth, map);
  const Mask& solid = wide.solid;
  const double reach = options.tolerance_cells + 0.5;  // a square step diagonal counts as near
  const Image<CellClass> classes = classes_of(map, layer, wide, options.operators);
  const auto called = [&](CellClass wanted) {
    return mask_of(solid, [&](std::size_t i) { return classes.pixels[i] == wanted; });
  };
  const Mask occupied = called(CellClass::occupied), free = called(CellClass::free);
  const Mask seen = mask_of(solid, [&](std::size_t i) { return classes.pixels[i] != CellClass::unknown; });
  const Mask truly_free = reachable_free(wide, options.path_m);
  const Mask near_solid = spread_largest(solid, reach), near_occupied = spread_largest(occupied, reach);
  const Mask near_free = spread_largest(truly_free, reach), beside_free = spread_largest(truly_free, 1);
  const Mask visible = options.seen_surfaces ? shifted_into(wide, truth, *options.seen_surfaces) : seen;
  const Mask near_visible = spread_largest(visible, reach);
  const auto both = [&](const Mask& a, const Mask& b) {
    return mask_of(a, [&](std::size_t i) { return (a.pixels[i] & b.pixels[i]) != 0; });
  };
  const auto without = [&](const Mask& a, const Mask& b) {
    return mask_of(a, [&](std::size_t i) { return a.pixels[i] != 0 && b.pixels[i] == 0; });
  };
  const Mask surfaces = both(both(solid, beside_free), near_visible), free_seen = both(truly_free, seen);

  LayerScore score;
  score.occupied = class_score(share(occupied, near_solid), share(surfaces, near_occupied));
  score.free = class_score(share(free, near_free), share(free_seen, free));
  score.coverage = share(truly_free, free);
  score.wrongly_blocked = share(free_seen, without(occupied, near_solid));
  score.wrongly_free = share(surfaces, without(free, near_occupied));
  return score;
}

}  // namespace flogmap
