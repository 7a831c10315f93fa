// The records of an MCAP file (https://mcap.dev/spec) as far as they are needed to find pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "camera/mcap/chunk_bytes.hpp"
#include "camera/mcap/field_reader.hpp"

namespace flogmap::mcap {

inline constexpr std::uint8_t kMagicBytes[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr ByteView kMagic{kMagicBytes};

/// A record is an opcode, the length of its content (64 bits) and the content.
inline constexpr std::size_t kRecordHead = 9;
inline constexpr std::uint64_t kFooterLength = 20;
inline constexpr std::size_t kMessageHead = 22;  // before a message's data

enum class Opcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  chunk_index = 8,
  statistics = 11,
  data_end = 15,
};  // others are passed over

struct Footer {
  std::uint64_t summary_start = 0;  // from the start of the file; 0: there is none
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;
};
struct Schema {
  std::uint16_t id = 0;
  std::string name;
};
struct Channel {
  std::uint16_t id = 0, schema_id = 0;
  std::string topic, message_encoding;
};
/// Views into the bytes of its chunk.
struct Message {
  std::uint16_t channel_id = 0;
  std::uint64_t log_time_ns = 0;
  ByteView data;
};
/// What stands before the packed records of a chunk. The compression is a view into the bytes read.
struct ChunkHead {
  std::uint64_t start_ns = 0, end_ns = 0;  // log times
  Packing packing;
  std::uint64_t packed_size = 0;
  std::size_t length = 0;  // of this head
};
struct ChunkIndex {
  std::uint64_t start_ns = 0, end_ns = 0;  // log times
  std::uint64_t offset = 0, length = 0;    // of the chunk's record, its head included
  std::vector<std::uint16_t> channels;     // that it has messages of; empty: not known
};
struct Statistics {
  std::uint32_t num_chunks = 0;
  std::map<std::uint16_t, std::uint64_t> num_messages;  // by channel; empty: not known
};

// Each takes the content of such a record; nothing if that is cut off or contradicts itself.
[[nodiscard]] std::optional<Footer> read_footer(ByteView content);
[[nodiscard]] std::optional<Schema> read_schema(ByteView content);
[[nodiscard]] std::optional<Channel> read_channel(ByteView content);
[[nodiscard]] std::optional<Message> read_message(ByteView content);
[[nodiscard]] std::optional<ChunkHead> read_chunk_head(ByteView content);
[[nodiscard]] std::optional<ChunkIndex> read_chunk_index(ByteView content);
[[nodiscard]] std::optional<Statistics> read_statistics(ByteView content);

/// Calls for every record in these bytes; false if the last one is cut off.
bool for_each_record(ByteView bytes, const std::function<void(Opcode, ByteView)>& call);

}  // namespace flogmap::mcap
