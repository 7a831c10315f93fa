#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "camera/mcap/field_reader.hpp"

namespace flogmap::mcap {

enum class Encoding : std::uint8_t { cdr, ros1, protobuf };
enum class Meaning : std::uint8_t { image, compressed_image, camera_info };

/// How the bytes of a channel's messages are to be read.
struct MessageKind {
  Encoding encoding = Encoding::cdr;
  Meaning meaning = Meaning::image;
};

/// Of sensor_msgs' Image, CompressedImage and CameraInfo (cdr of ROS 2, ros1), and of foxglove.RawImage,
/// CompressedImage and CameraCalibration (protobuf); nothing for all others.
[[nodiscard]] std::optional<MessageKind> message_kind(std::string_view schema, std::string_view encoding);

/// A reader behind what begins such a message: the four bytes that say CDR's byte order, where there are any.
/// Nothing for a protobuf message and for flavours of CDR that ROS 2 does not write.
[[nodiscard]] std::optional<FieldReader> ros_fields(Encoding encoding, ByteView message);

/// Reads std_msgs/Header; returns its stamp, nanoseconds.
[[nodiscard]] std::int64_t read_header(Encoding encoding, FieldReader& in);

/// One field of a protobuf message.
struct ProtobufField {
  std::uint32_t number = 0;
  bool is_number = true;    // else it has bytes
  std::uint64_t value = 0;  // a fixed one's bits
  ByteView bytes;           // of texts, bytes, messages inside, packed lists
};

/// Takes the next field off the front; nothing at the end, or at what is no protobuf.
[[nodiscard]] std::optional<ProtobufField> next_field(ByteView& message);

/// google.protobuf.Timestamp, nanoseconds.
[[nodiscard]] std::int64_t read_protobuf_time(ByteView timestamp);

}  // namespace flogmap::mcap
