#include "camera/mcap/contents.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "camera/mcap/scan.hpp"

namespace flogmap::mcap {
namespace {

struct OtherFormat {
  std::string_view magic, advice;
};
using namespace std::string_view_literals;
constexpr std::array kOtherFormats{
    OtherFormat{"#ROSBAG V2.0"sv, "it is a bag of ROS 1: convert it with `mcap convert IN.bag OUT.mcap`"sv},
    OtherFormat{"SQLite format 3"sv, "it is a bag of the sqlite3 kind: convert it with `ros2 bag convert`"sv},
    OtherFormat{"\x28\xB5\x2F\xFD"sv, "it is packed as a whole: unpack it with `zstd -d`"sv},
};

void check_magic(FileBytes& file) {
  const std::vector<std::uint8_t> start = file.read(0, 16);
  const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
  if (start.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), start.begin())) return;
  for (const OtherFormat& other : kOtherFormats) {
    if (!text.starts_with(other.magic)) continue;
    throw std::runtime_error(file.path() + ": not an MCAP file; " + std::string(other.advice));
  }
  throw std::runtime_error(file.path() + ": not an MCAP file");
}

/// Where a file is whole, its footer and the magic once more are its last bytes.
std::optional<Footer> footer_of(FileBytes& file) {
  constexpr std::size_t kTail = kRecordHead + kFooterLength + kMagic.size();
  if (file.size() < kMagic.size() + kTail) return std::nullopt;
  const std::vector<std::uint8_t> tail = file.read(file.size() - kTail, kTail);
  if (tail.size() != kTail || !std::equal(kMagic.begin(), kMagic.end(), tail.end() - kMagic.size()))
    return std::nullopt;
  std::optional<Footer> footer;
  for_each_record(ByteView(tail).first(kTail - kMagic.size()), [&](Opcode opcode, ByteView content) {
    if (opcode == Opcode::footer) footer = read_footer(content);
  });
  return footer;
}

bool checksum_fits(FileBytes& file, const Footer& footer) {
  if (footer.summary_crc == 0) return true;
  constexpr std::uint64_t kBlock = 1U << 20U;
  const std::uint64_t end = file.size() - kMagic.size() - sizeof(footer.summary_crc);
  std::uint32_t crc = 0;
  for (std::uint64_t at = footer.summary_start; at < end; at += kBlock)
    crc = crc32(file.read(at, std::min(kBlock, end - at)), crc);
  return crc == footer.summary_crc;
}

/// True if what the index names is there: chunks inside the file, all of them, their channels and schemas.
bool is_complete(const Contents& contents, const std::optional<Statistics>& statistics, std::uint64_t end) {
  if (contents.extents.empty() || contents.channels.empty()) return false;
  if (statistics && statistics->num_chunks != contents.extents.size()) return false;
  for (const auto& [id, channel] : contents.channels) {
    if (channel.schema_id != 0 && !contents.schemas.contains(channel.schema_id)) return false;
  }
  return std::all_of(contents.extents.begin(), contents.extents.end(), [&](const Extent& extent) {
    const bool inside =
        extent.offset >= kMagic.size() && extent.offset < end && extent.length <= end - extent.offset;
    return inside && std::all_of(extent.channels.begin(), extent.channels.end(),
                                 [&](std::uint16_t id) { return contents.channels.contains(id); });
  });
}

std::optional<Contents> read_summary(FileBytes& file, const Footer& footer) {
  if (footer.summary_start < kMagic.size() || footer.summary_start >= file.size()) return std::nullopt;
  if (!checksum_fits(file, footer)) return std::nullopt;
  Contents contents;
  std::optional<Statistics> statistics;
  (void)walk(file, footer.summary_start, [&](const RecordPlace& record) {
    if (record.opcode == Opcode::footer) return false;
    if (record.length > kMostRecordBytes) return true;
    const std::vector<std::uint8_t> content = file.read(record.content, record.length);
    note_definition(contents, record.opcode, content);
    if (record.opcode == Opcode::statistics) statistics = read_statistics(content);
    if (record.opcode == Opcode::chunk_index) {
      if (auto index = read_chunk_index(content)) {
        contents.extents.push_back(
            {index->offset, index->length, true, index->start_ns, index->end_ns, std::move(index->channels)});
      }
    }
    return true;
  });
  if (statistics) contents.num_messages = std::move(statistics->num_messages);
  if (!is_complete(contents, statistics, footer.summary_start)) return std::nullopt;
  return contents;
}

ChunkBytes unpack_record(ByteView record) {
  FieldReader in(record);
  const auto opcode = Opcode{in.number<std::uint8_t>()};
  const auto length = in.number<std::uint64_t>();
  const ByteView content = in.rest();
  const auto head = read_chunk_head(content);
  if (opcode != Opcode::chunk || length != content.size() || !head) return {{}, "not a chunk"};
  const ByteView packed = content.subspan(head->length);
  if (packed.size() < head->packed_size) return {{}, "cut off"};
  return unpack_chunk(packed.first(head->packed_size), head->packing);
}

}  // namespace

Contents read_contents(FileBytes& file) {
  check_magic(file);
  const std::optional<Footer> footer = footer_of(file);
  std::optional<Contents> contents;
  if (footer) contents = read_summary(file, *footer);
  if (!contents) contents = scan(file);
  std::sort(contents->extents.begin(), contents->extents.end(), [](const Extent& a, const Extent& b) {
    return std::pair(a.start_ns, a.offset) < std::pair(b.start_ns, b.offset);
  });
  return std::move(*contents);
}

ChunkBytes load_extent(FileBytes& file, const Extent& extent) {
  constexpr std::uint64_t kHeads = 1U << 10U;
  if (extent.length > kMostChunkBytes + kHeads) return {{}, "too large"};
  ChunkBytes loaded{file.read(extent.offset, extent.length), {}};
  if (loaded.bytes.size() != extent.length) return {{}, "cut off"};
  return extent.is_chunk ? unpack_record(loaded.bytes) : loaded;
}

void for_each_message(ByteView records, const std::function<void(const Message&)>& call) {
  for_each_record(records, [&](Opcode opcode, ByteView content) {
    if (opcode != Opcode::message) return;
    if (const auto message = read_message(content)) call(*message);
  });
}

}  // namespace flogmap::mcap
