// Which of its faces a map shows. FLOG.md section 5.
#pragma once

#include <cstdint>
#include <limits>

#include "mapping/flog/grid_spec.hpp"
#include "mapping/flog/map_value.hpp"

namespace flogmap {

/// visual: M; planning: M_p; motion: M_m; empty: E; confidence: K; conflict: 2 min(E, O) K; changed:
/// Cell::change.
enum class Style : std::uint8_t { visual, planning, motion, empty, confidence, conflict, changed };

/// Heights that matter to a robot, metres: the layers that meet [low_m, high_m) are fused, by max.
struct HeightRange {
  double low_m = -std::numeric_limits<double>::infinity();
  double high_m = std::numeric_limits<double>::infinity();
  bool operator==(const HeightRange&) const = default;
};

struct Rules {
  Style style = Style::visual;
  Operators operators = Operators::algebraic;
  double robot_radius_m = 0;  // pictures grow what they show by this; planes of single tiles do not
  HeightRange heights;        // for the fused map
};

inline bool meets(const HeightRange& heights, const GridSpec& grid, int layer) {
  return grid.layer_bounds_m[layer] < heights.high_m && grid.layer_bounds_m[layer + 1] > heights.low_m;
}

/// What a style shows of a cell, in [0, 1].
inline float style_value(const Rules& rules, const Cell& cell, float N_K) {
  const float E = mu_E(cell), O = mu_O(cell), K = confidence(cell, N_K);
  switch (rules.style) {
    case Style::visual:
      return cell.rays == 0 ? 0.0F : map_value(rules.operators, E, O, K);
    case Style::planning:
      return planning_value(rules.operators, O, K);
    case Style::motion:
      return motion_value(rules.operators, E, O, K);
    case Style::empty:
      return E;
    case Style::confidence:
      return K;
    case Style::conflict:
      return conflict_value(E, O, K);
    case Style::changed:
      return static_cast<float>(cell.change) / kMembershipScale;
  }
  return 0;
}

}  // namespace flogmap
