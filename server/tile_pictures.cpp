#include "server/tile_pictures.hpp"

#include <algorithm>
#include <vector>

#include "mapping/flog/map_planes.hpp"
#include "server/picture_encoding.hpp"

namespace flogmap {
namespace {

constexpr std::size_t kMostKept = 16384;  // a few hundred bytes to a few KiB each

Image<std::uint8_t> north_up(const PlaneBytes& plane) {
  Image<std::uint8_t> image(kTileSide, kTileSide);
  for (int y = 0; y < kTileSide; ++y) {
    std::copy_n(plane.begin() + (kTileSide - 1 - y) * kTileSide, kTileSide, image.row(y));
  }
  return image;
}

}  // namespace

PlaneBytes styled_plane(TileBoard& board, Slot slot, const PictureChoice& choice) {
  const int num_layers = board.info().grid.num_layers();
  if (choice.style != Style::visual) {
    Rules rules;
    rules.style = choice.style;
    rules.operators = board.operators();
    return value_plane(*board.tile(slot), board.info(), choice.layer, rules).pixels;
  }
  if (choice.layer) return board.value(slot, *choice.layer);
  PlaneBytes fused(kTileColumns);
  for (int layer = 0; layer < num_layers; ++layer) {
    const PlaneBytes plane = board.value(slot, layer);
    std::transform(plane.begin(), plane.end(), fused.begin(), fused.begin(),
                   [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  }
  return fused;
}

Bytes TilePictures::png(TileBoard& board, Slot slot, const PictureChoice& choice) {
  const Key key{slot, choice};
  const auto kept = kept_.find(key);
  if (kept != kept_.end() && kept->second.revision == board.revision(slot)) return kept->second.png;
  if (kept_.size() >= kMostKept) kept_.clear();
  const Bytes png =
      to_shared(encode_coloured_png(north_up(styled_plane(board, slot, choice)), choice.palette));
  kept_[key] = {board.revision(slot), png};
  return png;
}

}  // namespace flogmap
