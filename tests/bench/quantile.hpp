#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace flogmap {

/// -1 of no values.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return -1;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace flogmap
