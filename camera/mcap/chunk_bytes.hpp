#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "camera/mcap/field_reader.hpp"

namespace flogmap::mcap {

/// Chunks whose records take more than this are not read; recorders make them a thousandth of it.
inline constexpr std::uint64_t kMostChunkBytes = std::uint64_t{512} << 20U;

/// What a chunk holds once it is unpacked, or why it cannot be.
struct ChunkBytes {
  std::vector<std::uint8_t> bytes;
  std::string problem;  // empty if all went well
};

/// How a chunk is packed and what must come out of it.
struct Packing {
  std::string_view compression;         // "", "lz4" (frames) or "zstd"
  std::uint64_t uncompressed_size = 0;  // exactly
  std::uint32_t uncompressed_crc = 0;   // CRC-32; 0: not known
};

/// Unpacks a chunk's records. Sizes that the packed bytes cannot hold are refused before memory is taken.
[[nodiscard]] ChunkBytes unpack_chunk(ByteView packed, const Packing& packing);

/// CRC-32 (IEEE) of bytes that follow those which `before` is the CRC of.
[[nodiscard]] std::uint32_t crc32(ByteView bytes, std::uint32_t before = 0);

}  // namespace flogmap::mcap
