// A tile as bytes: its cells, 8 bytes each, zlib-compressed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mapping/tile_update.hpp"

namespace flogmap {

/// Turns the cells of tiles into bytes and back; keeps its working memory, so one per thread. Plain form:
/// cells in the order of Tile::cells; of each `empty, occupied, rays, change` as little-endian 16-bit
/// numbers.
class TileCodec {
 public:
  explicit TileCodec(int num_layers);
  TileCodec(TileCodec&&) noexcept;
  TileCodec& operator=(TileCodec&&) noexcept;
  ~TileCodec();

  /// zlib (RFC 1950) bytes. The tile must have num_layers * 4096 cells.
  [[nodiscard]] std::vector<std::uint8_t> encode(const Tile& tile);
  /// Nothing if the bytes are not exactly one tile of this many layers.
  [[nodiscard]] std::optional<TileCells> decode(std::span<const std::uint8_t> bytes);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

/// The plain form, for digests. `bytes` is replaced.
void cells_to_bytes(std::span<const Cell> cells, std::vector<std::uint8_t>& bytes);

}  // namespace flogmap
