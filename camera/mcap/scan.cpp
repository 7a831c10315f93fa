#include "camera/mcap/scan.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace flogmap::mcap {
namespace {

/// Adds a message to what is known of the extent that holds it.
void note_message(Contents& contents, Extent& extent, const Message& message) {
  extent.start_ns = std::min(extent.start_ns, message.log_time_ns);
  extent.end_ns = std::max(extent.end_ns, message.log_time_ns);
  const auto at = std::lower_bound(extent.channels.begin(), extent.channels.end(), message.channel_id);
  if (at == extent.channels.end() || *at != message.channel_id)
    extent.channels.insert(at, message.channel_id);
  ++contents.num_messages[message.channel_id];
}

Extent empty_extent(const RecordPlace& record) {
  return {.offset = record.offset,
          .length = 0,
          .is_chunk = record.opcode == Opcode::chunk,
          .start_ns = std::numeric_limits<std::uint64_t>::max(),
          .end_ns = 0,
          .channels = {}};
}

class Scan {
 public:
  explicit Scan(FileBytes& file) : file_(file) {}

  Contents run() {
    bool ended = false;
    const auto broken = walk(file_, kMagic.size(), [&](const RecordPlace& record) {
      ended = record.opcode == Opcode::data_end || record.opcode == Opcode::footer;
      if (!ended) visit(record);
      return !ended;
    });
    close_open();
    if (!ended) {
      contents_.damage = file_.path() + ": cut off or damaged at byte " +
                         std::to_string(broken.value_or(file_.size())) + " of " +
                         std::to_string(file_.size()) + "; read as far as it goes";
    }
    return std::move(contents_);
  }

 private:
  void visit(const RecordPlace& record) {
    switch (record.opcode) {
      case Opcode::message:
        return visit_message(record);
      case Opcode::chunk:
        close_open();
        return visit_chunk(record);
      case Opcode::schema:
      case Opcode::channel:
        if (record.length <= kMostRecordBytes)
          note_definition(contents_, record.opcode, file_.read(record.content, record.length));
        [[fallthrough]];
      default:
        close_open();
    }
  }

  /// Messages that follow one another in the file make one extent, as long as it stays small.
  void visit_message(const RecordPlace& record) {
    constexpr std::uint64_t kLargest = std::uint64_t{4} << 20U;
    const auto message = read_message(file_.read(record.content, kMessageHead));
    if (!message || record.length < kMessageHead) return close_open();
    const std::uint64_t length = kRecordHead + record.length;
    if (open_ && open_->length + length > kLargest) close_open();
    if (!open_) open_ = empty_extent(record);
    open_->length += length;
    note_message(contents_, *open_, *message);
  }

  void close_open() {
    if (open_) contents_.extents.push_back(*std::exchange(open_, std::nullopt));
  }

  void visit_chunk(const RecordPlace& record) {
    Extent extent = empty_extent(record);
    extent.length = kRecordHead + record.length;
    const ChunkBytes chunk = load_extent(file_, extent);
    for_each_record(chunk.bytes, [&](Opcode opcode, ByteView content) {
      note_definition(contents_, opcode, content);
      if (opcode != Opcode::message) return;
      if (const auto message = read_message(content)) note_message(contents_, extent, *message);
    });
    if (!chunk.problem.empty()) {  // stays in the list, where its loss is told when its turn comes
      extent.start_ns = last_start_ns_;
      extent.end_ns = last_start_ns_;
    } else if (extent.channels.empty()) {
      return;
    }
    last_start_ns_ = extent.start_ns;
    contents_.extents.push_back(std::move(extent));
  }

  FileBytes& file_;
  Contents contents_;
  std::optional<Extent> open_;  // messages outside chunks that may go on
  std::uint64_t last_start_ns_ = 0;
};

}  // namespace

std::optional<std::uint64_t> walk(FileBytes& file, std::uint64_t offset,
                                  const std::function<bool(const RecordPlace&)>& call) {
  while (offset < file.size()) {
    const std::vector<std::uint8_t> head = file.read(offset, kRecordHead);
    FieldReader in(head);
    RecordPlace record{.opcode = Opcode{in.number<std::uint8_t>()},
                       .offset = offset,
                       .content = offset + kRecordHead,
                       .length = in.number<std::uint64_t>()};
    if (!in.ok() || record.length > file.size() - record.content) return offset;
    if (!call(record)) return std::nullopt;
    offset = record.content + record.length;
  }
  return std::nullopt;
}

void note_definition(Contents& contents, Opcode opcode, ByteView content) {
  if (opcode == Opcode::schema) {
    if (auto schema = read_schema(content)) contents.schemas.try_emplace(schema->id, std::move(*schema));
  } else if (opcode == Opcode::channel) {
    if (auto channel = read_channel(content)) contents.channels.try_emplace(channel->id, std::move(*channel));
  }
}

Contents scan(FileBytes& file) { return Scan(file).run(); }

}  // namespace flogmap::mcap
