#pragma once

#include <cstddef>
#include <vector>

#include "map_bench_views.hpp"

namespace flogmap {

struct OctomapResult {
  std::vector<double> ms;  // processor time of insertPointCloud, per view
  std::size_t bytes = 0;   // of the tree after all views
};

/// The same rays into an OctoMap tree with cubes of cell_size_m.
OctomapResult run_octomap(const BenchViews& bench, double cell_size_m, double max_range_m);

/// Processor time of the whole program, milliseconds.
double cpu_ms();

}  // namespace flogmap
