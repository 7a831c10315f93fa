// What all rays of one view say about each cell: sums in whole numbers, so that no order and no number of
// threads changes a bit.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "mapping/flog/cell_fuse.hpp"
#include "mapping/flog/grid_spec.hpp"

namespace flogmap {

/// Memberships are counted in units of 1/65536 here.
inline constexpr std::uint64_t kEvidenceOne = 1U << 16U;

/// Sums of one cell; two words, so that one 128-bit addition adds a ray or a whole bundle of them.
struct EvidenceSum {
  std::uint64_t rays_and_empty = 0;  // n in the upper 24 bits, sum of mu_E * 65536 in the lower 40
  std::uint64_t occupied = 0;        // sum of mu_O * 65536

  void add(std::uint64_t rays, std::uint64_t empty, std::uint64_t occupied_sum) {
    rays_and_empty += (rays << 40U) + empty;
    occupied += occupied_sum;
  }
  EvidenceSum& operator+=(const EvidenceSum& other) {
    rays_and_empty += other.rays_and_empty;
    occupied += other.occupied;
    return *this;
  }
  [[nodiscard]] CellEvidence evidence() const {
    constexpr double kUnit = 1.0 / kEvidenceOne;
    const std::uint64_t empty = rays_and_empty & ((std::uint64_t{1} << 40U) - 1);
    return {static_cast<std::uint32_t>(rays_and_empty >> 40U), static_cast<double>(empty) * kUnit,
            static_cast<double>(occupied) * kUnit};
  }
};

/// A view may have at most this many rays, or the counts could overflow.
inline constexpr int kMaxRaysPerView = (1 << 24) - 1;

/// The sums of a view, tile by tile; a tile appears when it is first touched. Memory is kept from view to
/// view.
class ViewEvidence {
 public:
  explicit ViewEvidence(int num_layers) : num_layers_(num_layers) {}

  /// Forgets everything; from now on columns from `low` to `high` (inclusive) may be touched.
  void start(CellIndex low, CellIndex high);

  /// The sums of a column, one per layer. Valid until the next start().
  EvidenceSum* column(CellIndex cell) {
    std::vector<EvidenceSum>*& block = blocks_[place(tile_of(cell))];
    if (block == nullptr) block = touch(tile_of(cell));
    return block->data() + std::size_t(column_in_tile(cell)) * std::size_t(num_layers_);
  }

  /// Tiles touched since start(), in the order of their first touch.
  [[nodiscard]] const std::vector<TileIndex>& touched() const { return touched_; }

  /// Sums of a tile: [column_in_tile * num_layers + layer]; null if it was not touched.
  [[nodiscard]] const EvidenceSum* tile(TileIndex index) const {
    const std::vector<EvidenceSum>* block = contains(index) ? blocks_[place(index)] : nullptr;
    return block == nullptr ? nullptr : block->data();
  }

 private:
  [[nodiscard]] std::size_t place(TileIndex index) const {
    return std::size_t(index.y - low_.y) * std::size_t(width_) + std::size_t(index.x - low_.x);
  }
  [[nodiscard]] bool contains(TileIndex index) const {
    return index.x >= low_.x && index.y >= low_.y && index.x < low_.x + width_ && index.y < low_.y + height_;
  }
  std::vector<EvidenceSum>* touch(TileIndex index);

  int num_layers_;
  TileIndex low_{};
  int width_ = 0;  // of the window, in tiles
  int height_ = 0;
  std::vector<std::vector<EvidenceSum>*> blocks_;  // of the window; null where untouched
  std::vector<TileIndex> touched_;
  std::deque<std::vector<EvidenceSum>> pool_;  // the first touched_.size() are in use
};

}  // namespace flogmap
