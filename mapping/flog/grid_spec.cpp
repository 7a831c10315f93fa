#include "mapping/flog/grid_spec.hpp"

#include <stdexcept>
#include <string>

namespace flogmap {

void check(const GridSpec& grid) {
  if (!(grid.cell_size_m >= 0.001 && grid.cell_size_m <= 10)) {
    throw std::invalid_argument("cell_size_m must be from 0.001 to 10 m, got " +
                                std::to_string(grid.cell_size_m));
  }
  const auto& z = grid.layer_bounds_m;
  if (z.size() < 2 || z.size() > 65) {
    throw std::invalid_argument("layer_bounds_m must hold 2 to 65 heights (1 to 64 layers), got " +
                                std::to_string(z.size()));
  }
  for (std::size_t k = 0; k < z.size(); ++k) {
    const bool rises = k == 0 || z[k] - z[k - 1] >= 0.001;
    if (!std::isfinite(z[k]) || !rises) {
      throw std::invalid_argument("layer_bounds_m must rise by at least 0.001 m from height to height, got " +
                                  std::to_string(z[k]) + " at place " + std::to_string(k));
    }
  }
}

}  // namespace flogmap
