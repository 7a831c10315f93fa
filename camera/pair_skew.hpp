#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace flogmap {

/// How far apart the two pictures of a pair were taken: counts per bin of |skew|.
struct SkewHistogram {
  static constexpr std::array<double, 9> kUpperMs{0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50};
  std::array<std::int64_t, kUpperMs.size() + 1> counts{};  // the last one: beyond all bounds
  double sum_ms = 0;                                       // of |skew|
  double largest_ms = 0;                                   // |skew|

  void add(std::int64_t skew_ns) {
    constexpr double kMsPerNs = 1e-6;
    const double ms = std::abs(static_cast<double>(skew_ns)) * kMsPerNs;
    const auto bin = std::lower_bound(kUpperMs.begin(), kUpperMs.end(), ms) - kUpperMs.begin();
    ++counts[static_cast<std::size_t>(bin)];
    sum_ms += ms;
    largest_ms = std::max(largest_ms, ms);
  }
  [[nodiscard]] std::int64_t total() const {
    return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  }
  [[nodiscard]] double mean_ms() const {
    const std::int64_t pairs = total();
    return pairs > 0 ? sum_ms / static_cast<double>(pairs) : 0;
  }
};

/// The skew of all pairs of a source, and those of them that were dropped because of it.
struct PairSkew {
  SkewHistogram histogram;
  double allowed_ms = 0;
  std::int64_t num_dropped = 0;  // taken further apart than allowed
};

}  // namespace flogmap
