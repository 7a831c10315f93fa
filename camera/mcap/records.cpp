#include "camera/mcap/records.hpp"

namespace flogmap::mcap {

std::optional<Footer> read_footer(ByteView content) {
  FieldReader in(content);
  Footer footer;
  footer.summary_start = in.number<std::uint64_t>();
  footer.summary_offset_start = in.number<std::uint64_t>();
  footer.summary_crc = in.number<std::uint32_t>();
  return in.ok() ? std::optional(footer) : std::nullopt;
}

std::optional<Schema> read_schema(ByteView content) {
  FieldReader in(content);
  Schema schema;
  schema.id = in.number<std::uint16_t>();
  schema.name = in.text();
  return in.ok() && schema.id != 0 ? std::optional(std::move(schema)) : std::nullopt;
}

std::optional<Channel> read_channel(ByteView content) {
  FieldReader in(content);
  Channel channel;
  channel.id = in.number<std::uint16_t>();
  channel.schema_id = in.number<std::uint16_t>();
  channel.topic = in.text();
  channel.message_encoding = in.text();
  return in.ok() ? std::optional(std::move(channel)) : std::nullopt;
}

std::optional<Message> read_message(ByteView content) {
  FieldReader in(content);
  Message message;
  message.channel_id = in.number<std::uint16_t>();
  (void)in.number<std::uint32_t>();  // sequence
  message.log_time_ns = in.number<std::uint64_t>();
  (void)in.number<std::uint64_t>();  // publish_time
  message.data = in.rest();
  return in.ok() ? std::optional(message) : std::nullopt;
}

std::optional<ChunkHead> read_chunk_head(ByteView content) {
  FieldReader in(content);
  ChunkHead head;
  head.start_ns = in.number<std::uint64_t>();
  head.end_ns = in.number<std::uint64_t>();
  head.packing.uncompressed_size = in.number<std::uint64_t>();
  head.packing.uncompressed_crc = in.number<std::uint32_t>();
  head.packing.compression = in.text();
  head.packed_size = in.number<std::uint64_t>();
  head.length = in.position();
  return in.ok() ? std::optional(head) : std::nullopt;
}

std::optional<ChunkIndex> read_chunk_index(ByteView content) {
  FieldReader in(content);
  ChunkIndex index;
  index.start_ns = in.number<std::uint64_t>();
  index.end_ns = in.number<std::uint64_t>();
  index.offset = in.number<std::uint64_t>();
  index.length = in.number<std::uint64_t>();
  FieldReader offsets(in.counted_bytes());
  while (offsets.left() > 0 && offsets.ok()) {
    index.channels.push_back(offsets.number<std::uint16_t>());
    (void)offsets.number<std::uint64_t>();  // of its message index
  }
  return in.ok() && offsets.ok() ? std::optional(std::move(index)) : std::nullopt;
}

std::optional<Statistics> read_statistics(ByteView content) {
  FieldReader in(content);
  Statistics statistics;
  (void)in.bytes(8 + 2 + 4 + 4 + 4);  // numbers of messages, schemas, channels, attachments, metadata
  statistics.num_chunks = in.number<std::uint32_t>();
  (void)in.bytes(8 + 8);  // first and last log time
  FieldReader counts(in.counted_bytes());
  while (counts.left() > 0 && counts.ok()) {
    const auto channel = counts.number<std::uint16_t>();
    statistics.num_messages[channel] = counts.number<std::uint64_t>();
  }
  return in.ok() && counts.ok() ? std::optional(std::move(statistics)) : std::nullopt;
}

bool for_each_record(ByteView bytes, const std::function<void(Opcode, ByteView)>& call) {
  FieldReader in(bytes);
  while (in.left() > 0) {
    const auto opcode = Opcode{in.number<std::uint8_t>()};
    const auto length = in.number<std::uint64_t>();
    const ByteView content = in.bytes(length);
    if (!in.ok()) return false;
    call(opcode, content);
  }
  return true;
}

}  // namespace flogmap::mcap
