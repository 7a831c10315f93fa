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

/// A bundle of rays may be shared out between neighbouring cells, in parts of 1/64.
inline constexpr std::uint64_t kWholeShare = 64;

/// Sums of one cell; two words, so that one 128-bit addition adds a ray or a whole bundle of them.
struct EvidenceSum {
  std::uint64_t rays_and_empty = 0;  // whole rays in the upper 24 bits, sum of mu_E * 65536 in the lower 40
  std::uint64_t parts_and_occupied = 0;  // 64ths of rays in the upper 24 bits, sum of mu_O * 65536 below

  void add(std::uint64_t rays, std::uint64_t empty, std::uint64_t occupied) {
    rays_and_empty += (rays << 40U) + empty;
    parts_and_occupied += occupied;
  }
  /// Only share/64 of a bundle. At most 2^18 times a view, or the 64ths could overflow.
  void add_share(std::uint64_t share, std::uint64_t rays, std::uint64_t empty, std::uint64_t occupied) {
    const std::uint64_t parts = rays * share;
    rays_and_empty += (parts / kWholeShare << 40U) + empty * share / kWholeShare;
    parts_and_occupied += (parts % kWholeShare << 40U) + occupied * share / kWholeShare;
  }
  EvidenceSum& operator+=(const EvidenceSum& other) {
    rays_and_empty += other.rays_and_empty;
    parts_and_occupied += other.parts_and_occupied;
    return *this;
  }
  [[nodiscard]] bool empty() const { return rays_and_empty == 0 && parts_and_occupied == 0; }

  /// The number of rays is rounded; the means of their memberships are kept.
  [[nodiscard]] CellEvidence evidence() const {
    const std::uint64_t low = (std::uint64_t{1} << 40U) - 1;
    const std::uint64_t parts = (rays_and_empty >> 40U) * kWholeShare + (parts_and_occupied >> 40U);
    const std::uint64_t rays = (parts + kWholeShare / 2) / kWholeShare;
    if (rays == 0) return {};
    const double unit = static_cast<double>(rays * kWholeShare) / static_cast<double>(parts) / kEvidenceOne;
    return {static_cast<std::uint32_t>(rays), static_cast<double>(rays_and_empty & low) * unit,
            static_cast<double>(parts_and_occupied & low) * unit};
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
