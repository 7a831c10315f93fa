#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>

#include "mapping/flog/map_rules.hpp"
#include "server/palette.hpp"
#include "server/tile_board.hpp"

namespace flogmap {

/// What a picture of a tile shows; without a layer all are fused.
struct PictureChoice {
  std::optional<int> layer;
  Style style = Style::visual;
  Palette palette = Palette::grey;
  auto operator<=>(const PictureChoice&) const = default;
};

/// A tile's plane of bytes for a style, row 0 at the lowest y. Overviews show M by max of M.
PlaneBytes styled_plane(TileBoard& board, Slot slot, const PictureChoice& choice);

/// PNG files of tiles, north up, kept while their tile does not change.
class TilePictures {
 public:
  Bytes png(TileBoard& board, Slot slot, const PictureChoice& choice);

 private:
  struct Key {
    Slot slot = 0;
    PictureChoice choice;
    auto operator<=>(const Key&) const = default;
  };
  struct Kept {
    std::uint64_t revision = 0;
    Bytes png;
  };
  std::map<Key, Kept> kept_;
};

}  // namespace flogmap
