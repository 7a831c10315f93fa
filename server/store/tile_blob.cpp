#include "server/store/tile_blob.hpp"

#include <libdeflate.h>

#include <stdexcept>

namespace flogmap {
namespace {

constexpr std::size_t kCellBytes = 8;
constexpr int kCompression = 4;  // beyond, bytes hardly shrink while the time doubles

std::uint8_t low(std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xff); }
std::uint8_t high(std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); }
std::uint16_t u16(const std::uint8_t* at) { return static_cast<std::uint16_t>(at[0] | (at[1] << 8)); }

}  // namespace

void cells_to_bytes(std::span<const Cell> cells, std::vector<std::uint8_t>& bytes) {
  bytes.resize(cells.size() * kCellBytes);
  std::uint8_t* out = bytes.data();
  for (const Cell& cell : cells) {
    for (const std::uint16_t value : {cell.empty, cell.occupied, cell.rays, cell.change}) {
      *out++ = low(value);
      *out++ = high(value);
    }
  }
}

struct TileCodec::Buffers {
  struct Free {
    void operator()(libdeflate_compressor* tool) const { libdeflate_free_compressor(tool); }
    void operator()(libdeflate_decompressor* tool) const { libdeflate_free_decompressor(tool); }
  };
  std::unique_ptr<libdeflate_compressor, Free> compressor{libdeflate_alloc_compressor(kCompression)};
  std::unique_ptr<libdeflate_decompressor, Free> decompressor{libdeflate_alloc_decompressor()};
  std::size_t num_cells = 0;
  std::vector<std::uint8_t> plain;
};

TileCodec::TileCodec(int num_layers) : buffers_(std::make_unique<Buffers>()) {
  if (!buffers_->compressor || !buffers_->decompressor) throw std::bad_alloc();
  buffers_->num_cells = static_cast<std::size_t>(num_layers) * kTileColumns;
}
TileCodec::TileCodec(TileCodec&&) noexcept = default;
TileCodec& TileCodec::operator=(TileCodec&&) noexcept = default;
TileCodec::~TileCodec() = default;

std::vector<std::uint8_t> TileCodec::encode(const Tile& tile) {
  if (tile.cells.size() != buffers_->num_cells)
    throw std::invalid_argument("a tile of another number of layers");
  cells_to_bytes(tile.cells, buffers_->plain);
  const auto& plain = buffers_->plain;
  std::vector<std::uint8_t> bytes(libdeflate_zlib_compress_bound(buffers_->compressor.get(), plain.size()));
  bytes.resize(libdeflate_zlib_compress(buffers_->compressor.get(), plain.data(), plain.size(), bytes.data(),
                                        bytes.size()));
  return bytes;
}

std::optional<TileCells> TileCodec::decode(std::span<const std::uint8_t> bytes) {
  auto& plain = buffers_->plain;
  plain.resize(buffers_->num_cells * kCellBytes);
  // Without a place for the produced size, anything but exactly plain.size() bytes is an error.
  const auto result = libdeflate_zlib_decompress(buffers_->decompressor.get(), bytes.data(), bytes.size(),
                                                 plain.data(), plain.size(), nullptr);
  if (result != LIBDEFLATE_SUCCESS) return std::nullopt;
  TileCells cells(buffers_->num_cells);
  const std::uint8_t* at = plain.data();
  for (Cell& cell : cells) {
    cell = {u16(at), u16(at + 2), u16(at + 4), u16(at + 6)};
    at += kCellBytes;
  }
  return cells;
}

}  // namespace flogmap
