#include "camera/mcap/message_kind.hpp"

#include <array>
#include <limits>

namespace flogmap::mcap {
namespace {

struct KnownKind {
  std::string_view schema, encoding;
  MessageKind kind;
};
constexpr std::array kKnown{
    KnownKind{"sensor_msgs/msg/Image", "cdr", {Encoding::cdr, Meaning::image}},
    KnownKind{"sensor_msgs/msg/CompressedImage", "cdr", {Encoding::cdr, Meaning::compressed_image}},
    KnownKind{"sensor_msgs/msg/CameraInfo", "cdr", {Encoding::cdr, Meaning::camera_info}},
    KnownKind{"sensor_msgs/Image", "ros1", {Encoding::ros1, Meaning::image}},
    KnownKind{"sensor_msgs/CompressedImage", "ros1", {Encoding::ros1, Meaning::compressed_image}},
    KnownKind{"sensor_msgs/CameraInfo", "ros1", {Encoding::ros1, Meaning::camera_info}},
    KnownKind{"foxglove.RawImage", "protobuf", {Encoding::protobuf, Meaning::image}},
    KnownKind{"foxglove.CompressedImage", "protobuf", {Encoding::protobuf, Meaning::compressed_image}},
    KnownKind{"foxglove.CameraCalibration", "protobuf", {Encoding::protobuf, Meaning::camera_info}},
};

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

/// What no clock says becomes 0, as a stamp that was never set.
std::int64_t time_ns(std::int64_t seconds, std::int64_t nanoseconds) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / kNsPerSecond - 1;
  if (seconds < 0 || seconds > kMost || nanoseconds < 0 || nanoseconds >= kNsPerSecond) return 0;
  return seconds * kNsPerSecond + nanoseconds;
}

/// Seven bits a byte, the lowest first; nothing if it does not end within the ten bytes that 64 bits take.
std::optional<std::uint64_t> take_varint(ByteView& message) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64 && !message.empty(); shift += 7) {
    const std::uint8_t byte = message.front();
    message = message.subspan(1);
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80U) return value;
  }
  return std::nullopt;
}

}  // namespace

std::optional<MessageKind> message_kind(std::string_view schema, std::string_view encoding) {
  for (const KnownKind& known : kKnown) {
    if (known.schema == schema && known.encoding == encoding) return known.kind;
  }
  return std::nullopt;
}

std::optional<FieldReader> ros_fields(Encoding encoding, ByteView message) {
  if (encoding == Encoding::ros1) return FieldReader(message);
  constexpr std::size_t kEncapsulation = 4;
  if (encoding != Encoding::cdr || message.size() < kEncapsulation || message[0] != 0) return std::nullopt;
  // Odd ones are little-endian: 0 and 1 are CDR, 6 and 7 its second version, which aligns to 4 at most.
  const std::uint8_t flavour = message[1];
  const bool first = flavour < 2, second = flavour == 6 || flavour == 7;
  if (!first && !second) return std::nullopt;
  const FieldReader::Layout layout{.big_endian = flavour % 2 == 0,
                                   .max_alignment = first ? std::size_t{8} : std::size_t{4},
                                   .texts_end_with_a_null = true};
  return FieldReader(message.subspan(kEncapsulation), layout);
}

std::int64_t read_header(Encoding encoding, FieldReader& in) {
  if (encoding == Encoding::ros1) (void)in.number<std::uint32_t>();  // seq
  const std::int64_t seconds =
      encoding == Encoding::ros1 ? std::int64_t{in.number<std::uint32_t>()} : in.number<std::int32_t>();
  const std::int64_t stamp_ns = time_ns(seconds, in.number<std::uint32_t>());
  (void)in.text();  // frame_id
  return stamp_ns;
}

std::optional<ProtobufField> next_field(ByteView& message) {
  const auto tag = take_varint(message);
  if (!tag) return std::nullopt;
  ProtobufField field;
  field.number = static_cast<std::uint32_t>(*tag >> 3U);
  enum : std::uint8_t { varint = 0, fixed64 = 1, counted = 2, fixed32 = 5 };
  const auto type = static_cast<unsigned>(*tag & 7U);
  FieldReader in(message);
  if (type == fixed64) field.value = in.number<std::uint64_t>();
  if (type == fixed32) field.value = in.number<std::uint32_t>();
  if (type == fixed64 || type == fixed32) {
    message = in.rest();
    return in.ok() ? std::optional(field) : std::nullopt;
  }
  const auto number = take_varint(message);
  if (!number || (type != varint && type != counted)) return std::nullopt;
  field.value = *number;
  if (type == varint) return field;
  if (*number > message.size()) return std::nullopt;
  field.is_number = false;
  field.bytes = message.first(*number);
  message = message.subspan(*number);
  return field;
}

std::int64_t read_protobuf_time(ByteView timestamp) {
  std::int64_t seconds = 0, nanoseconds = 0;
  while (const auto field = next_field(timestamp)) {
    if (field->number == 1) seconds = static_cast<std::int64_t>(field->value);
    if (field->number == 2) nanoseconds = static_cast<std::int64_t>(field->value);
  }
  return time_ns(seconds, nanoseconds);
}

}  // namespace flogmap::mcap
