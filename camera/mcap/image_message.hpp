#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "camera/mcap/message_kind.hpp"
#include "camera/picture_files.hpp"

namespace flogmap::mcap {

/// A picture as a message holds it. Views into the message's bytes.
struct ImageMessage {
  std::int64_t stamp_ns = 0;  // of its header; 0: not set
  bool compressed = false;    // then `data` is a JPEG or PNG, and of the rest only `encoding` is set
  std::string_view encoding;  // "mono8", "bgr8", ...; "jpeg" and the like
  std::uint32_t width = 0, height = 0;
  std::uint32_t step = 0;  // bytes per row, padding included
  bool big_endian = false;
  ByteView data;
};

/// Reads a message of an image's kind without looking at pixels; nothing if it is cut off or no such message.
[[nodiscard]] std::optional<ImageMessage> read_image_message(MessageKind kind, ByteView message);

/// Its pixels, or why there are none. Colours come out as blue, green, red; raw colour filters are
/// interpolated; alpha is dropped.
[[nodiscard]] ReadPicture decode_image(const ImageMessage& image);

}  // namespace flogmap::mcap
