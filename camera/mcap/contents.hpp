#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "camera/mcap/file_bytes.hpp"
#include "camera/mcap/records.hpp"

namespace flogmap::mcap {

/// A stretch of a file that holds messages: the record of a chunk, or records that lie open.
struct Extent {
  std::uint64_t offset = 0, length = 0;  // bytes of the file
  bool is_chunk = false;
  std::uint64_t start_ns = 0, end_ns = 0;  // log times of its messages
  std::vector<std::uint16_t> channels;     // that it has messages of; empty: not known
};

/// What a file holds, without its messages.
struct Contents {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<Extent> extents;                          // by their start
  std::map<std::uint16_t, std::uint64_t> num_messages;  // by channel; empty: not known
  std::string damage;                                   // in words; empty: none was found
};

/// From the summary at the file's end; where there is none, as in a recording whose recorder was killed, from
/// one pass over the whole file, as far as it goes. Throws std::runtime_error naming the file if it is no
/// MCAP file.
[[nodiscard]] Contents read_contents(FileBytes& file);

/// The records of an extent, unpacked, or why they cannot be had.
[[nodiscard]] ChunkBytes load_extent(FileBytes& file, const Extent& extent);

/// Calls for every message among these records, in their order.
void for_each_message(ByteView records, const std::function<void(const Message&)>& call);

}  // namespace flogmap::mcap
