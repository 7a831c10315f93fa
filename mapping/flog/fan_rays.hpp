// The rays of a view, seen from above and sorted by azimuth. FLOG.md section 7, point 1.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mapping/flog/azimuth_bins.hpp"
#include "mapping/flog/ray_model.hpp"
#include "mapping/view.hpp"

namespace flogmap {

/// A ray as a line over the ground: everything is measured in rho, the horizontal distance from the camera;
/// metres.
struct FanRay {
  float hit_m = 0;         // rho of the hit
  float width_m = 0;       // m seen from above, > 0
  float run_per_rise = 0;  // change of rho per metre of height, signed, never 0
  float end_m = 0;         // the ray touches [0, end_m)
};

/// Azimuths within a bin, in 256ths of its width.
struct AzimuthRange {
  std::uint8_t least = 255, greatest = 0;

  void join(const AzimuthRange& other) {
    least = std::min(least, other.least);
    greatest = std::max(greatest, other.greatest);
  }
};

/// All rays of a view in one array, bin after bin. The memory is kept from view to view.
class FanRays {
 public:
  /// Sorts the rays of a view on num_threads threads.
  void sort(const RayModel& model, const View& view, int num_threads);

  [[nodiscard]] const AzimuthBins& bins() const { return bins_; }

  /// The azimuths that the rays of a bin really have: the fan's line goes through their middle.
  [[nodiscard]] AzimuthSpread spread(int bin) const;
  [[nodiscard]] const FanRay* begin(int bin) const { return rays_.data() + begin_[bin]; }
  [[nodiscard]] const FanRay* end(int bin) const { return rays_.data() + begin_[bin + 1]; }
  [[nodiscard]] std::uint32_t size() const { return begin_.back(); }

 private:
  struct RowRays;

  /// Of one row: how many rays fall into each bin, and where in it.
  void count_rays(int thread, const std::uint16_t* bin, const std::uint8_t* part, int count);
  void place_rays(int thread, const std::uint16_t* bin, const RowRays& rays, int count);

  /// Counts become places: in each bin the rays of the first thread, then of the second ...
  void start_bins();

  AzimuthBins bins_;
  std::vector<std::uint32_t> begin_;  // where each bin starts; one more than there are bins
  std::vector<std::vector<std::uint32_t>>
      place_;                                     // per thread and bin: a count, then where the next ray goes
  std::vector<std::vector<AzimuthRange>> range_;  // per thread and bin; after sorting the first holds all
  std::vector<FanRay> rays_;
};

}  // namespace flogmap
