// Everything about the map that can be chosen.
#pragma once

#include <cstdint>

#include "mapping/flog/grid_spec.hpp"

namespace flogmap {

/// fan: fast, all rays of one azimuth at once (FLOG.md section 7). ray: one after the other, the reference.
enum class IntegratorKind : std::uint8_t { fan, ray };

struct FlogOptions {
  GridSpec grid;
  double max_range_m = 5;           // a longer ray only says where it is free, up to here
  double max_incidence_deg = 76;    // pixels that see a surface more askew are left out; 90: none
  int row_step = 1;                 // every row_step-th row of a view is used ...
  int column_step = 1;              // ... and every column_step-th column
  bool paper_mode = false;          // memberships literally as in the paper; FLOG.md sections 1 and 2
  double full_confidence_rays = 0;  // N_K of every layer; 0 = derived from camera and cells
  int min_rays = 8;                 // a cell is "seen" from this N on
  int num_threads = 0;              // 0 = one per processor; the map does not depend on it
  IntegratorKind integrator = IntegratorKind::fan;
};

/// Throws std::invalid_argument naming field, value and what is allowed.
void check(const FlogOptions& options);

}  // namespace flogmap
