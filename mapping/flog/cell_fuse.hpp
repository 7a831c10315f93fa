// How rays change a cell: one by one, or all rays of a view at once. FLOG.md section 3, eqs. (8)(9).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "mapping/flog/cell.hpp"

namespace flogmap {

/// Cap of N(C): N_f = 3 N_K, as far as 16 bits reach. Beyond it old evidence fades by 1 - 1/N_f a ray.
inline std::uint16_t max_rays(double N_K) {
  return static_cast<std::uint16_t>(std::clamp(std::round(3.0 * N_K), 1.0, 65535.0));
}

/// A cell's evidence in full precision: the reference for the 16-bit Cell.
struct ExactCell {
  double E = 0;
  double O = 0;
  double N = 0;
};

/// One ray seen through the cell. Eqs. (8)(9), word for word.
inline void fuse(ExactCell& cell, double mu_E, double mu_O, double N_f) {
  cell.N = std::min(cell.N + 1, N_f);
  cell.E = ((cell.N - 1) * cell.E + mu_E) / cell.N;
  cell.O = ((cell.N - 1) * cell.O + mu_O) / cell.N;
}

/// What all rays of one view say about a cell.
struct CellEvidence {
  std::uint32_t rays = 0;  // n
  double empty = 0;        // sum of mu_E
  double occupied = 0;     // sum of mu_O; empty + occupied <= n
};

/// Merges whole views into the cells of one layer. Equal to (8)(9) while N + n <= N_f; beyond it every ray is
/// taken to say the view's mean, so the order of the rays does not matter.
class CellMerger {
 public:
  /// N_K: rays of full confidence of the layer, >= 1.
  explicit CellMerger(double N_K) : N_f_(max_rays(N_K)), rays_before_change_(N_K / 8) {
    double fade = 1.0 - 1.0 / N_f_;
    for (double& power : fade_) power = std::exchange(fade, fade * fade);
  }

  /// Requires evidence.rays > 0.
  void merge(Cell& cell, const CellEvidence& evidence) const {
    const std::uint32_t N = cell.rays, n = evidence.rays;
    if (N >= rays_before_change_ || cell.change != 0) note_change(cell, evidence);
    if (N + n <= N_f_) {
      const double share = 1.0 / (N + n);
      set(cell, (N * double{mu_E(cell)} + evidence.empty) * share,
          (N * double{mu_O(cell)} + evidence.occupied) * share);
    } else {
      merge_saturating(cell, evidence);
    }
    cell.rays = static_cast<std::uint16_t>(std::min(N + n, N_f_));
  }

 private:
  static std::uint16_t quantised(double membership) {
    return static_cast<std::uint16_t>(membership * kMembershipScale + 0.5);
  }

  /// (1 - 1/N_f)^s by squaring: the same bits on every machine.
  [[nodiscard]] double faded(std::uint32_t s) const {
    double w = 1;
    for (std::size_t bit = 0; s != 0; s >>= 1, ++bit) {
      if (s & 1U) w *= fade_[bit];
    }
    return w;
  }

  static void set(Cell& cell, double E, double O) {
    cell.empty = quantised(E);
    cell.occupied = std::min(quantised(O), static_cast<std::uint16_t>(65535 - cell.empty));
  }

  /// The first a1 rays fill the cell up to N_f, the other s = n - a1 let it fade towards the view's mean x.
  void merge_saturating(Cell& cell, const CellEvidence& evidence) const {
    const std::uint32_t N = cell.rays, n = evidence.rays;
    const double x_E = evidence.empty / n, x_O = evidence.occupied / n;
    const std::uint32_t a1 = N_f_ > N ? N_f_ - N : 0;
    const double E1 = (N * double{mu_E(cell)} + a1 * x_E) / (N + a1);
    const double O1 = (N * double{mu_O(cell)} + a1 * x_O) / (N + a1);
    const double w = faded(n - a1);
    set(cell, w * E1 + (1 - w) * x_E, w * O1 + (1 - w) * x_O);
  }

  /// Keeps the largest recent |x_O - O|, decaying by 7/8 a view; a cell hardly seen before cannot change.
  void note_change(Cell& cell, const CellEvidence& evidence) const {
    const double x_O = evidence.occupied / evidence.rays;
    const auto decayed = static_cast<std::uint16_t>(cell.change * 7U / 8U);
    const bool known = cell.rays > 0 && cell.rays >= rays_before_change_;
    cell.change = known ? std::max(decayed, quantised(std::abs(x_O - double{mu_O(cell)}))) : decayed;
  }

  std::uint32_t N_f_;
  double rays_before_change_;
  std::array<double, 32> fade_{};  // (1 - 1/N_f)^(2^i)
};

}  // namespace flogmap
