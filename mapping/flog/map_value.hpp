// From the evidence of a cell to a map value, by rules that can be changed. FLOG.md section 5, eqs. (11)(12).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mapping/flog/cell.hpp"

namespace flogmap {

/// Which fuzzy "and", "or" and "not" the rules use.
enum class Operators : std::uint8_t { algebraic, minmax, lukasiewicz };

inline constexpr float kObstacleThreshold = 0.3F;  // on M: an obstacle from here on

/// Fuzzy conjunction of a and b in [0, 1].
constexpr float fuzzy_and(Operators operators, float a, float b) {
  switch (operators) {
    case Operators::minmax:
      return std::min(a, b);
    case Operators::lukasiewicz:
      return std::max(0.0F, a + b - 1.0F);
    case Operators::algebraic:
      break;
  }
  return a * b;
}

/// Fuzzy disjunction of a and b in [0, 1].
constexpr float fuzzy_or(Operators operators, float a, float b) {
  switch (operators) {
    case Operators::minmax:
      return std::max(a, b);
    case Operators::lukasiewicz:
      return std::min(1.0F, a + b);
    case Operators::algebraic:
      break;
  }
  return a + b - a * b;
}

constexpr float fuzzy_not(float a) { return 1.0F - a; }

/// not((E and not O) or I) with I = not E and not O: how little speaks for "free or unknown". Eq. (11).
constexpr float not_free_nor_unknown(Operators operators, float E, float O) {
  const float I = fuzzy_and(operators, fuzzy_not(E), fuzzy_not(O));
  return fuzzy_not(fuzzy_or(operators, fuzzy_and(operators, E, fuzzy_not(O)), I));
}

/// Layer value M_k of the visual map, in [0, 1]; unknown and free are 0. Eq. (11). K stands outside the
/// complement.
constexpr float map_value(Operators operators, float E, float O, float K) {
  return fuzzy_and(operators, not_free_nor_unknown(operators, E, O), K);
}

/// Safe for planning: unknown counts as free. M_p = O and K.
constexpr float planning_value(Operators operators, float O, float K) { return fuzzy_and(operators, O, K); }

/// Safe for motion: unknown counts as occupied. Confidence is folded into E and O first.
constexpr float motion_value(Operators operators, float E, float O, float K) {
  const float Eh = E * K;
  const float Oh = O * K;
  const float Ih = fuzzy_and(operators, fuzzy_not(Eh), fuzzy_not(Oh));
  return fuzzy_not(fuzzy_and(operators, fuzzy_and(operators, Eh, fuzzy_not(Oh)), fuzzy_not(Ih)));
}

/// How much the evidence contradicts itself: 2 min(E, O) K.
constexpr float conflict_value(float E, float O, float K) { return 2.0F * std::min(E, O) * K; }

enum class CellClass : std::uint8_t { unknown, free, occupied };

/// Class of a cell for trinary maps, scores and routes: K does not decide what is an obstacle.
inline CellClass classify(Operators operators, const Cell& cell, int min_rays) {
  if (cell.rays < min_rays) return CellClass::unknown;
  const float M = map_value(operators, mu_E(cell), mu_O(cell), 1.0F);
  return M >= kObstacleThreshold ? CellClass::occupied : CellClass::free;
}

}  // namespace flogmap
