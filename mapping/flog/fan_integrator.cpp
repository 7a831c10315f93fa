#include "mapping/flog/fan_integrator.hpp"

#include <algorithm>

#include "mapping/flog/fan_line.hpp"
#include "mapping/flog/fan_shares.hpp"
#include "mapping/flog/fan_sums.hpp"
#include "mapping/flog/threads.hpp"

namespace flogmap {
namespace {

/// Cuts the bins into equal parts by the rays in them, neighbours together, so that threads share few tiles.
std::vector<int> equal_parts(const FanRays& rays, int parts) {
  std::vector<int> cuts{0};
  for (int bin = 0; bin < rays.bins().count(); ++bin) {
    const auto before = static_cast<std::uint64_t>(rays.begin(bin) - rays.begin(0));
    while (static_cast<int>(cuts.size()) < parts &&
           before * parts >= std::uint64_t{rays.size()} * cuts.size()) {
      cuts.push_back(bin);
    }
  }
  cuts.resize(parts + 1, rays.bins().count());
  return cuts;
}

}  // namespace

void FanIntegrator::integrate(const View& view, std::vector<ViewEvidence>& sums) {
  const int num_threads = static_cast<int>(sums.size());
  rays_.sort(model_, view, num_threads);
  const std::vector<int> cuts = equal_parts(rays_, num_threads);
  run_on_threads(num_threads, [&](int thread) {
    integrate_bins(view.world_from_camera, cuts[thread], cuts[thread + 1], sums[thread]);
  });
}

void FanIntegrator::integrate_bins(const SE3& world_from_camera, int first_bin, int end_bin,
                                   ViewEvidence& evidence) const {
  const Eigen::Vector3d T = world_from_camera.translation();
  FanLine line;
  FanShares shares;
  FanSums sums(grid_);
  for (int bin = first_bin; bin < end_bin; ++bin) {
    float end_m = 0;
    for (const FanRay* ray = rays_.begin(bin); ray != rays_.end(bin); ++ray)
      end_m = std::max(end_m, ray->end_m);
    if (end_m <= 0) continue;
    const AzimuthSpread spread = rays_.spread(bin);
    line.walk(grid_, T.head<2>(), spread.direction, end_m);
    sums.start(line, T.z());
    for (const FanRay* ray = rays_.begin(bin); ray != rays_.end(bin); ++ray) sums.add(line, *ray);
    shares.share_out(grid_, T.head<2>(), spread, line);
    sums.flush(line, shares, evidence);
  }
}

}  // namespace flogmap
