#include "mapping/flog/full_confidence.hpp"

#include <algorithm>
#include <cmath>

namespace flogmap {

std::vector<float> full_confidence_rays(const StereoCamera& camera, const GridSpec& grid,
                                        double max_disparity_px, int row_step, int column_step) {
  const double f = camera.focal_px, t = camera.baseline_m, a = grid.cell_size_m;
  const double n_r = row_step, n_c = column_step;
  std::vector<float> rays;
  for (int k = 0; k < grid.num_layers(); ++k) {
    const double h = grid.layer_bounds_m[k + 1] - grid.layer_bounds_m[k];
    const double Z_c =
        std::max({f * t / max_disparity_px, f * h / camera.height_px, f * a / camera.width_px});
    const double N_K = f * f * a * h / (Z_c * Z_c * n_r * n_c);
    rays.push_back(static_cast<float>(std::max(1.0, std::round(N_K))));
  }
  return rays;
}

}  // namespace flogmap
