// A cell of the map and its update. FLOG.md section 3, eqs. (8)-(10).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace flogmap {

inline constexpr float kMembershipScale = 65535.0F;  // Cell::empty and ::occupied are memberships times this

/// Fuzzy evidence of one cell: 8 bytes. Unseen: all zero. Always empty + occupied <= 65535 (within one step).
struct Cell {
  std::uint16_t empty = 0;     // mu_E(C) = empty / 65535
  std::uint16_t occupied = 0;  // mu_O(C) = occupied / 65535
  std::uint16_t rays = 0;      // N(C), saturates at N_f
  std::uint16_t change = 0;    // largest recent |view's mean mu_O - O before|, / 65535; decays by 7/8 a view

  bool operator==(const Cell&) const = default;
};

inline float mu_E(const Cell& cell) { return static_cast<float>(cell.empty) / kMembershipScale; }
inline float mu_O(const Cell& cell) { return static_cast<float>(cell.occupied) / kMembershipScale; }

/// Confidence K = min(1, N / N_K). Eq. (10). N_K >= 1: full_confidence_rays of the cell's layer.
inline float confidence(const Cell& cell, float N_K) {
  return std::min(1.0F, static_cast<float>(cell.rays) / N_K);
}

}  // namespace flogmap
