#include "camera/mcap/chunk_bytes.hpp"

#include <libdeflate.h>
#include <lz4frame.h>
#include <zstd.h>

#include <memory>

namespace flogmap::mcap {
namespace {

// The least that can stand for the most: LZ4 needs a byte for 255, zstd four for a block of 128 KiB.
constexpr std::uint64_t kMostLz4Ratio = 256, kMostZstdRatio = 1U << 16U;

struct FreeZstd {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};
struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

/// True if the frames fill the target to its end, and nothing more.
bool unpack_zstd(ByteView packed, std::vector<std::uint8_t>& target) {
  const std::unique_ptr<ZSTD_DCtx, FreeZstd> context(ZSTD_createDCtx());
  const std::size_t size =
      ZSTD_decompressDCtx(context.get(), target.data(), target.size(), packed.data(), packed.size());
  return ZSTD_isError(size) == 0 && size == target.size();
}

bool unpack_lz4(ByteView packed, std::vector<std::uint8_t>& target) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) return false;
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(made);
  std::size_t from = 0, to = 0, hint = 1;
  while (from < packed.size()) {  // a frame or several
    std::size_t read = packed.size() - from, written = target.size() - to;
    hint = LZ4F_decompress(context.get(), target.data() + to, &written, packed.data() + from, &read, nullptr);
    if (LZ4F_isError(hint) != 0 || (read == 0 && written == 0)) return false;
    from += read;
    to += written;
  }
  return hint == 0 && to == target.size();
}

std::string bytes_text(std::uint64_t count) { return std::to_string(count) + " bytes"; }

}  // namespace

std::uint32_t crc32(ByteView bytes, std::uint32_t before) {
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

ChunkBytes unpack_chunk(ByteView packed, const Packing& packing) {
  const std::string_view kind = packing.compression;
  if (!kind.empty() && kind != "lz4" && kind != "zstd")
    return {{}, "compression must be none, lz4 or zstd, got '" + std::string(kind) + "'"};
  const std::uint64_t size = packing.uncompressed_size;
  const std::uint64_t ratio = kind == "zstd" ? kMostZstdRatio : kMostLz4Ratio;
  const bool possible = kind.empty() ? size == packed.size() : size / ratio <= packed.size();
  if (!possible || size > kMostChunkBytes) {
    return {{}, "says that " + bytes_text(packed.size()) + " unpack to " + bytes_text(size)};
  }
  ChunkBytes chunk;
  if (kind.empty()) {
    chunk.bytes.assign(packed.begin(), packed.end());
  } else {
    chunk.bytes.resize(size);
    const bool whole = kind == "zstd" ? unpack_zstd(packed, chunk.bytes) : unpack_lz4(packed, chunk.bytes);
    if (!whole) return {{}, "damaged " + std::string(kind) + " data"};
  }
  if (packing.uncompressed_crc != 0 && crc32(chunk.bytes) != packing.uncompressed_crc)
    return {{}, "its checksum differs"};
  return chunk;
}

}  // namespace flogmap::mcap
