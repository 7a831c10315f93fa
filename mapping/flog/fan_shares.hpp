// How the rays of a bin share the columns beside its line: the bin is a narrow wedge, and a corner of a
// column may lie inside it.
#pragma once

#include <cstdint>
#include <vector>

#include "mapping/flog/azimuth_bins.hpp"
#include "mapping/flog/fan_line.hpp"
#include "mapping/flog/view_evidence.hpp"

namespace flogmap {

/// Of the rays over column j of a line, in 64ths: how many cross that very column, and how many cross those
/// of its two neighbours across the main axis that the line itself does not meet. The line drifts towards one
/// of them, which the rays enter late, about where the line comes to column j + 1; they leave the other one
/// early.
struct FanShare {
  std::uint8_t own = kWholeShare;
  std::uint8_t drift = 0;    // the neighbour the line drifts towards
  std::uint8_t counter = 0;  // the opposite one
};

/// The shares of a line. Without them a far column, only a few bins wide, would count whole bins or none.
class FanShares {
 public:
  /// For rays that are spread evenly over the wedge around the line, which starts at start_m (world).
  void share_out(const GridSpec& grid, const Eigen::Vector2d& start_m, const AzimuthSpread& spread,
                 const FanLine& line);

  /// False where the wedge is no wider than the line: every column has the whole share.
  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] FanShare at(int j) const { return shares_[j]; }
  [[nodiscard]] CellIndex drift_of(CellIndex cell) const { return {cell.x + drift_.x, cell.y + drift_.y}; }
  [[nodiscard]] CellIndex counter_of(CellIndex cell) const { return {cell.x - drift_.x, cell.y - drift_.y}; }

 private:
  bool any_ = false;
  CellIndex drift_{};  // the step across the line's main axis that the line itself makes now and then
  std::vector<FanShare> shares_;
};

}  // namespace flogmap
