// Going through a file record by record: what read_contents does where no summary helps.
#pragma once

#include <functional>
#include <optional>

#include "camera/mcap/contents.hpp"

namespace flogmap::mcap {

/// Records other than messages and chunks that are larger are passed over.
inline constexpr std::uint64_t kMostRecordBytes = std::uint64_t{16} << 20U;

struct RecordPlace {
  Opcode opcode{};
  std::uint64_t offset = 0;   // in the file
  std::uint64_t content = 0;  // likewise, behind the head
  std::uint64_t length = 0;   // of the content
};

/// Calls for the records from `offset` on, until told to stop by false. Where a record does not fit into the
/// file, its offset; nothing otherwise.
[[nodiscard]] std::optional<std::uint64_t> walk(FileBytes& file, std::uint64_t offset,
                                                const std::function<bool(const RecordPlace&)>& call);

/// Notes a schema or a channel, the first of each id; other records are none of its business.
void note_definition(Contents& contents, Opcode opcode, ByteView content);

/// What a file holds by its records alone; every chunk is unpacked once.
[[nodiscard]] Contents scan(FileBytes& file);

}  // namespace flogmap::mcap
