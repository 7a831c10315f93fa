// Sums over the rays of one azimuth, as differences from column to column. FLOG.md section 7, points 3 and 4.
#pragma once

#include <cstdint>
#include <vector>

#include "mapping/flog/fan_line.hpp"
#include "mapping/flog/fan_rays.hpp"
#include "mapping/flog/view_evidence.hpp"

namespace flogmap {

/// Seen from above both memberships of a ray are made of two ramps of rho: `met` rises from 0 at l - m to 1
/// at l, `passed` rises from 0 at l to 1 at l + m; mu_E = 1 - met, mu_O = met - passed. Each ramp is a
/// constant plus a slope times rho, so a ray changes the sums only at the few columns where a ramp begins or
/// ends. Everything is kept in whole numbers: no order of the rays changes a bit.
class FanSums {
 public:
  FanSums(const GridSpec& grid, int num_layers) : grid_(grid), num_layers_(num_layers) {}

  /// Starts a line of columns; heights are seen from a camera at camera_z_m.
  void start(const FanLine& line, double camera_z_m);

  void add(const FanLine& line, const FanRay& ray);

  /// Adds the sums to the evidence of the line's cells and forgets them.
  void flush(const FanLine& line, ViewEvidence& evidence);

 private:
  /// How the ramps change at a column: constants, and slopes per metre of rho.
  struct Change {
    std::int64_t met = 0, met_slope = 0, passed = 0, passed_slope = 0;
  };
  struct Ramps;

  void add_stretch(const FanLine& line, const Ramps& ramps, int layer, float from_m, float to_m);
  void add_hit(const FanLine& line, const Ramps& ramps, Change* changes, int first, int last, float from_m,
               float to_m) const;

  const GridSpec& grid_;
  int num_layers_;
  int stride_ = 0;                    // columns per layer
  std::vector<float> bounds_m_;       // heights of the layers' bounds above the camera
  std::vector<std::int32_t> counts_;  // [layer * stride + column]: rays that begin minus rays that ended
  std::vector<Change> changes_;       // likewise
};

}  // namespace flogmap
