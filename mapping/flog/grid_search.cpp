#include "mapping/flog/grid_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <queue>

namespace flogmap {
namespace {

constexpr GridPlace kSteps[8] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
constexpr std::uint8_t kUnreached = 255;

float straight_length(GridPlace a, GridPlace b) {
  return std::hypot(static_cast<float>(a.x - b.x), static_cast<float>(a.y - b.y));
}

/// 1 where it is comfortable, 3 where it is only just wide enough.
float cost_per_cell(const GridClearance& grid, GridPlace p) {
  const float room = grid.comfortable - grid.least;
  if (room <= 0) return 1;
  const float tight = std::clamp((grid.comfortable - grid.clearance.at(p.x, p.y)) / room, 0.0F, 1.0F);
  return 1 + 2 * tight * tight;
}

/// An open cell; among equals the one with the lower number comes first, so that the way is always the same.
struct Open {
  float estimate;
  int place;
  bool operator<(const Open& other) const {
    return estimate != other.estimate ? estimate > other.estimate : place > other.place;
  }
};

class Search {
 public:
  Search(const GridClearance& grid, GridPlace from, GridPlace to)
      : grid_(grid),
        to_(to),
        cost_(grid.clearance.width, grid.clearance.height, std::numeric_limits<float>::infinity()),
        step_(grid.clearance.width, grid.clearance.height, kUnreached) {
    cost_.at(from.x, from.y) = 0;
    open_.push({straight_length(from, to), number(from)});
  }

  bool reach() {
    while (!open_.empty()) {
      const Open next = open_.top();
      open_.pop();
      const GridPlace here{next.place % cost_.width, next.place / cost_.width};
      if (here == to_) return true;
      if (next.estimate > cost_.at(here.x, here.y) + straight_length(here, to_) + 1e-3F)
        continue;  // outdated
      for (std::uint8_t i = 0; i < 8; ++i) visit(here, i);
    }
    return false;
  }

  [[nodiscard]] std::vector<GridPlace> way_from(GridPlace from) const {
    std::vector<GridPlace> way{to_};
    while (way.back() != from) {
      const GridPlace p = way.back(), step = kSteps[step_.at(p.x, p.y)];
      way.push_back({p.x - step.x, p.y - step.y});
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  [[nodiscard]] int number(GridPlace p) const { return p.y * cost_.width + p.x; }

  void visit(GridPlace here, std::uint8_t i) {
    const GridPlace there{here.x + kSteps[i].x, here.y + kSteps[i].y};
    if (!grid_.passable(there)) return;
    const float length = i < 4 ? 1.0F : std::numbers::sqrt2_v<float>;
    const float cost =
        cost_.at(here.x, here.y) + length * 0.5F * (cost_per_cell(grid_, here) + cost_per_cell(grid_, there));
    if (cost >= cost_.at(there.x, there.y)) return;
    cost_.at(there.x, there.y) = cost;
    step_.at(there.x, there.y) = i;
    open_.push({cost + straight_length(there, to_), number(there)});
  }

  const GridClearance& grid_;
  GridPlace to_;
  Image<float> cost_;
  Image<std::uint8_t> step_;  // how the cell was reached: index into kSteps
  std::priority_queue<Open> open_;
};

}  // namespace

std::vector<GridPlace> cheapest_way(const GridClearance& grid, GridPlace from, GridPlace to) {
  Search search(grid, from, to);
  return search.reach() ? search.way_from(from) : std::vector<GridPlace>{};
}

float least_clearance(const GridClearance& grid, GridPlace a, GridPlace b) {
  const int samples = 2 * std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), 1});
  float least = std::numeric_limits<float>::infinity();
  for (int i = 0; i <= samples; ++i) {
    const double share = double{1} * i / samples;
    const auto x = static_cast<int>(std::lround(a.x + share * (b.x - a.x)));
    const auto y = static_cast<int>(std::lround(a.y + share * (b.y - a.y)));
    least = std::min(least, grid.clearance.at(x, y));
  }
  return least;
}

std::vector<GridPlace> straightened(const GridClearance& grid, const std::vector<GridPlace>& way) {
  std::vector<GridPlace> corners;
  if (way.empty()) return corners;
  corners.push_back(way.front());
  std::size_t from = 0;
  while (from + 1 < way.size()) {
    std::size_t best = from + 1;
    float narrowest = grid.comfortable;
    for (std::size_t to = from + 1; to < way.size(); ++to) {
      narrowest = std::min(narrowest, grid.clearance.at(way[to].x, way[to].y));
      // Looking ever farther ahead is quadratic: after a while every eighth cell is enough.
      const bool worth_a_look = to < from + 64 || (to - from) % 8 == 0 || to + 1 == way.size();
      if (worth_a_look && least_clearance(grid, way[from], way[to]) >= narrowest) best = to;
    }
    corners.push_back(way[best]);
    from = best;
  }
  return corners;
}

}  // namespace flogmap
