#include "mapping/flog/ray_integrator.hpp"

namespace flogmap {
namespace {

std::uint64_t fixed(double membership) {
  return static_cast<std::uint64_t>(membership * double{kEvidenceOne} + 0.5);
}

void add_ray(const GridSpec& grid, const MeasuredRay& measured, ViewEvidence& evidence) {
  const double l = measured.l, m = measured.m;
  for_each_cell(grid, measured.ray, [&](const Chord& chord) {
    const double r = chord.nearest_m;
    const std::uint64_t empty = fixed(mu_E(r, l, m));
    const std::uint64_t occupied = std::min(fixed(mu_O(r, l, m)), kEvidenceOne - empty);
    evidence.column(chord.column)[chord.layer].add(1, empty, occupied);
  });
}

}  // namespace

void integrate_ray_by_ray(const RayModel& model, const GridSpec& grid, const View& view,
                          ViewEvidence& evidence) {
  const Image<float>& d = view.disparity.px;
  for (int y = 0; y < d.height; y += model.row_step) {
    for (int x = 0; x < d.width; x += model.column_step) {
      const auto ray = measured_ray(model, view.world_from_camera, x, y, d.at(x, y));
      if (ray) add_ray(grid, *ray, evidence);
    }
  }
}

}  // namespace flogmap
