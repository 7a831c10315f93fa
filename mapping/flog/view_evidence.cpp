#include "mapping/flog/view_evidence.hpp"

#include <algorithm>

namespace flogmap {

void ViewEvidence::start(CellIndex low, CellIndex high) {
  low_ = tile_of(low);
  const TileIndex last = tile_of(high);
  width_ = last.x - low_.x + 1;
  height_ = last.y - low_.y + 1;
  blocks_.assign(std::size_t(width_) * std::size_t(height_), nullptr);
  touched_.clear();
}

std::vector<EvidenceSum>* ViewEvidence::touch(TileIndex index) {
  const std::size_t used = touched_.size();
  if (used == pool_.size()) pool_.emplace_back();
  pool_[used].assign(std::size_t(kTileColumns) * std::size_t(num_layers_), EvidenceSum{});
  touched_.push_back(index);
  return &pool_[used];
}

}  // namespace flogmap
