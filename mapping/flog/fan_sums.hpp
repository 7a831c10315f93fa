// Sums over the rays of one azimuth, as differences from column to column. FLOG.md section 7, points 3 and 4.
#pragma once

#include <cstdint>
#include <vector>

#include "mapping/flog/fan_line.hpp"
#include "mapping/flog/fan_rays.hpp"
#include "mapping/flog/fan_shares.hpp"
#include "mapping/flog/view_evidence.hpp"

namespace flogmap {

/// Seen from above both memberships of a ray are made of two ramps of rho: `met` rises from 0 at l - m to 1
/// at l, `passed` rises from 0 at l to 1 at l + m; mu_E = 1 - met, mu_O = met - passed. Each ramp is a
/// constant plus a slope times rho, so a ray changes the sums only at the few columns where a ramp begins or
/// ends. Everything is kept in whole numbers: no order of the rays changes a bit.
class FanSums {
 public:
  explicit FanSums(const GridSpec& grid)
      : grid_(grid), layers_(grid.num_layers()), bundles_(grid.num_layers()) {}

  /// Starts a line of columns; heights are seen from a camera at camera_z_m.
  void start(const FanLine& line, double camera_z_m);

  void add(const FanLine& line, const FanRay& ray);

  /// Adds the sums to the evidence of the line's cells, and of those beside it, and forgets them.
  void flush(const FanLine& line, const FanShares& shares, ViewEvidence& evidence);

 private:
  /// How the ramps change at a column: constants, and slopes per metre of rho.
  struct Change {
    std::int64_t met = 0, met_slope = 0, passed = 0, passed_slope = 0;
  };
  struct Ramps;

  /// One layer over the columns of the line.
  struct Layer {
    std::vector<std::int32_t> counts;  // rays that begin at a column minus rays that ended before it
    std::vector<Change> changes;       // not zero at most within [first_change, last_change]
    int first_change = 0, last_change = -1;

    // While the sums are added up:
    std::int64_t rays = 0;
    Change ramps;
  };

  void add_stretch(const FanLine& line, const Ramps& ramps, Layer& layer, float from_m, float to_m) const;
  void add_hit(const FanLine& line, const Ramps& ramps, Layer& layer, int first, int last, float from_m,
               float to_m) const;
  /// What the rays over one column say of one layer.
  struct Bundle {
    std::uint64_t rays = 0, empty = 0, occupied = 0;
  };
  static Bundle take_bundle(Layer& layer, int j, float rho_m);
  static void give(const Bundle& bundle, int share, EvidenceSum& sum);

  const GridSpec& grid_;
  std::vector<float> bounds_m_;  // heights of the layers' bounds above the camera
  std::vector<Layer> layers_;
  std::vector<Bundle> bundles_;  // of one column, while the sums are given away
};

}  // namespace flogmap
