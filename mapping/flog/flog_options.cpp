#include "mapping/flog/flog_options.hpp"

#include <stdexcept>
#include <string>

namespace flogmap {
namespace {

template <typename T>
void require_within(const char* field, T value, T low, T high) {
  if (value >= low && value <= high) return;  // false for NaN as well
  throw std::invalid_argument(std::string(field) + " must be from " + std::to_string(low) + " to " +
                              std::to_string(high) + ", got " + std::to_string(value));
}

}  // namespace

void check(const FlogOptions& options) {
  check(options.grid);
  require_within("max_range_m", options.max_range_m, 0.1, 200.0);
  require_within("max_range_m / cell_size_m", options.max_range_m / options.grid.cell_size_m, 1.0, 10'000.0);
  require_within("max_incidence_deg", options.max_incidence_deg, 30.0, 90.0);
  require_within("row_step", options.row_step, 1, 64);
  require_within("column_step", options.column_step, 1, 64);
  require_within("full_confidence_rays", options.full_confidence_rays, 0.0, 65'535.0);
  require_within("min_rays", options.min_rays, 1, 65'535);
  require_within("num_threads", options.num_threads, 0, 256);
}

}  // namespace flogmap
