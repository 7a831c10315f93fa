#include "tests/camera/mcap_writer.hpp"

#include <libdeflate.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>

namespace flogmap::testing {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

std::string packed(const std::string& compression, const std::string& plain) {
  if (compression.empty()) return plain;
  std::string out;
  if (compression == "zstd") {
    out.resize(ZSTD_compressBound(plain.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1));
  } else {
    out.resize(LZ4F_compressFrameBound(plain.size(), nullptr));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), nullptr));
  }
  return out;
}

FieldWriter ros_writer(Dialect dialect) {
  if (dialect == Dialect::ros1) return {};
  return {dialect == Dialect::cdr_big, 8, true};
}

std::string with_encapsulation(Dialect dialect, const FieldWriter& fields) {
  if (dialect == Dialect::ros1) return fields.bytes();
  return std::string(1, '\0') + (dialect == Dialect::cdr_big ? '\0' : '\1') + std::string(2, '\0') +
         fields.bytes();
}

void write_header(FieldWriter& out, Dialect dialect, std::int64_t stamp_ns) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  if (dialect == Dialect::ros1) out.number(std::uint32_t{7});  // seq
  out.number(static_cast<std::uint32_t>(stamp_ns / kNsPerSecond))
      .number(static_cast<std::uint32_t>(stamp_ns % kNsPerSecond))
      .text("camera");
}

std::string varint(std::uint64_t value) {
  std::string out;
  for (; value >= 0x80; value >>= 7U) out += static_cast<char>(value | 0x80U);
  return out + static_cast<char>(value);
}
std::string field(unsigned number, const std::string& bytes) {
  return varint(number * 8 + 2) + varint(bytes.size()) + bytes;
}
std::string fixed(unsigned number, std::uint32_t value) {
  return varint(number * 8 + 5) + FieldWriter().number(value).bytes();
}
std::string time_field(std::int64_t stamp_ns) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  return field(1, varint(8) + varint(stamp_ns / kNsPerSecond) + varint(16) + varint(stamp_ns % kNsPerSecond));
}

}  // namespace

McapWriter::McapWriter(McapLayout layout) : layout_(std::move(layout)), file_(kMagic) {
  file_ += record(1, FieldWriter().text("ros2").text("a test").bytes());
}

std::string McapWriter::record(std::uint8_t opcode, const std::string& content) {
  return FieldWriter().number(opcode).number(std::uint64_t{content.size()}).raw(content).bytes();
}

int McapWriter::add_channel(const std::string& topic, const std::string& schema,
                            const std::string& encoding) {
  const auto id = ++num_channels_;
  const std::string records =
      record(3, FieldWriter().number(id).text(schema).text("ros2msg").text("# a comment").bytes()) +
      record(4, FieldWriter().number(id).number(id).text(topic).text(encoding).counted("").bytes());
  definitions_ += records;
  (layout_.chunks ? chunk_ : file_) += records;
  return id;
}

void McapWriter::add_message(int channel_id, std::uint64_t log_time_ns, const std::string& data) {
  const auto channel = static_cast<std::uint16_t>(channel_id);
  const std::string message = record(5, FieldWriter()
                                            .number(channel)
                                            .number(std::uint32_t{1})
                                            .number(log_time_ns)
                                            .number(log_time_ns)
                                            .raw(data)
                                            .bytes());
  ++counts_[channel];
  if (!layout_.chunks) {
    file_ += message;
    return;
  }
  index_entries_[channel] += FieldWriter().number(log_time_ns).number(std::uint64_t{chunk_.size()}).bytes();
  chunk_ += message;
  chunk_start_ns_ = in_chunk_ == 0 ? log_time_ns : std::min(chunk_start_ns_, log_time_ns);
  chunk_end_ns_ = in_chunk_ == 0 ? log_time_ns : std::max(chunk_end_ns_, log_time_ns);
  if (++in_chunk_ == layout_.messages_per_chunk) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::string records = packed(layout_.compression, chunk_);
  const std::uint32_t crc = layout_.checksums ? libdeflate_crc32(0, chunk_.data(), chunk_.size()) : 0;
  const std::string chunk = record(6, FieldWriter()
                                          .number(chunk_start_ns_)
                                          .number(chunk_end_ns_)
                                          .number(std::uint64_t{chunk_.size()})
                                          .number(crc)
                                          .text(layout_.compression)
                                          .number(std::uint64_t{records.size()})
                                          .raw(records)
                                          .bytes());
  const std::uint64_t offset = file_.size();
  file_ += chunk;
  std::string offsets, message_indexes;
  for (const auto& [channel, entries] : index_entries_) {
    offsets += FieldWriter().number(channel).number(file_.size() + message_indexes.size()).bytes();
    message_indexes += record(7, FieldWriter().number(channel).counted(entries).bytes());
  }
  file_ += message_indexes;
  chunk_indexes_ += record(8, FieldWriter()
                                  .number(chunk_start_ns_)
                                  .number(chunk_end_ns_)
                                  .number(offset)
                                  .number(std::uint64_t{chunk.size()})
                                  .counted(offsets)
                                  .number(std::uint64_t{message_indexes.size()})
                                  .text(layout_.compression)
                                  .number(std::uint64_t{records.size()})
                                  .number(std::uint64_t{chunk_.size()})
                                  .bytes());
  chunk_.clear();
  index_entries_.clear();
  in_chunk_ = 0;
  ++num_chunks_;
}

void McapWriter::add_record(std::uint8_t opcode, const std::string& content) {
  file_ += record(opcode, content);
}

std::string McapWriter::indexes() const {
  std::string counts;
  for (const auto& [channel, count] : counts_) counts += FieldWriter().number(channel).number(count).bytes();
  return definitions_ + chunk_indexes_ +
         record(11, FieldWriter()
                        .number(std::uint64_t{0})
                        .number(num_channels_)
                        .number(std::uint32_t{num_channels_})
                        .number(std::uint32_t{0})
                        .number(std::uint32_t{0})
                        .number(num_chunks_)
                        .number(std::uint64_t{0})
                        .number(std::uint64_t{0})
                        .counted(counts)
                        .bytes());
}

std::string McapWriter::finish() {
  end_chunk();
  file_ += record(15, FieldWriter().number(std::uint32_t{0}).bytes());
  const std::uint64_t start = layout_.summary ? file_.size() : 0;
  std::string tail = layout_.summary ? indexes() : "";
  tail += FieldWriter().number(std::uint8_t{2}).number(std::uint64_t{20}).bytes();
  tail += FieldWriter().number(start).number(std::uint64_t{0}).bytes();
  const std::uint32_t crc = layout_.checksums ? libdeflate_crc32(0, tail.data(), tail.size()) : 0;
  return file_ + tail + FieldWriter().number(layout_.summary ? crc : 0).bytes() + std::string(kMagic);
}

std::string schema_name(Dialect dialect, const std::string& type) {
  if (dialect == Dialect::ros1) return "sensor_msgs/" + type;
  if (dialect != Dialect::foxglove) return "sensor_msgs/msg/" + type;
  return "foxglove." + (type == "Image" ? "RawImage" : type == "CameraInfo" ? "CameraCalibration" : type);
}

std::string encoding_name(Dialect dialect) {
  return dialect == Dialect::ros1 ? "ros1" : dialect == Dialect::foxglove ? "protobuf" : "cdr";
}

SentImage sent(const Picture& picture, std::int64_t stamp_ns, const std::string& encoding,
               std::uint32_t padding) {
  SentImage image{.stamp_ns = stamp_ns, .encoding = encoding, .data = {}};
  image.width = picture.width;
  image.height = picture.height;
  const std::uint32_t row = picture.width * picture.channels * picture.bits / 8;
  image.step = row + padding;
  for (int y = 0; y < picture.height; ++y)
    image.data += std::string(picture.bytes.begin() + y * row, picture.bytes.begin() + (y + 1) * row) +
                  std::string(padding, '\xEE');
  return image;
}

std::string image_message(Dialect dialect, const SentImage& image) {
  if (dialect == Dialect::foxglove) {
    return time_field(image.stamp_ns) + field(7, "camera") + fixed(2, image.width) + fixed(3, image.height) +
           field(4, image.encoding) + fixed(5, image.step) + field(6, image.data);
  }
  FieldWriter out = ros_writer(dialect);
  write_header(out, dialect, image.stamp_ns);
  out.number(image.height).number(image.width).text(image.encoding);
  out.number(static_cast<std::uint8_t>(image.big_endian ? 1 : 0)).number(image.step).counted(image.data);
  return with_encapsulation(dialect, out);
}

std::string compressed_message(Dialect dialect, std::int64_t stamp_ns, const std::string& format,
                               const std::string& data) {
  if (dialect == Dialect::foxglove)
    return time_field(stamp_ns) + field(4, "camera") + field(2, data) + field(3, format);
  FieldWriter out = ros_writer(dialect);
  write_header(out, dialect, stamp_ns);
  out.text(format).counted(data);
  return with_encapsulation(dialect, out);
}

std::string info_message(Dialect dialect, const RosCameraInfo& info) {
  const auto width = static_cast<std::uint32_t>(info.width_px);
  const auto height = static_cast<std::uint32_t>(info.height_px);
  const auto doubles = [](FieldWriter out, const std::vector<double>& values) {
    for (const double value : values) out.number(value);
    return out;
  };
  if (dialect == Dialect::foxglove) {
    const auto packed_list = [&](const std::vector<double>& values) { return doubles({}, values).bytes(); };
    return time_field(1) + field(9, "camera") + fixed(2, width) + fixed(3, height) +
           field(4, info.distortion_model) + field(5, packed_list(info.distortion_coefficients)) +
           field(6, packed_list(info.camera_matrix)) + field(7, packed_list(info.rectification_matrix)) +
           field(8, packed_list(info.projection_matrix));
  }
  FieldWriter out = ros_writer(dialect);
  write_header(out, dialect, 1);
  out.number(height).number(width).text(info.distortion_model);
  out.number(static_cast<std::uint32_t>(info.distortion_coefficients.size()));
  for (const auto* list : {&info.distortion_coefficients, &info.camera_matrix, &info.rectification_matrix,
                           &info.projection_matrix})
    out = doubles(out, *list);
  return with_encapsulation(dialect, out.number(std::uint32_t{0}).number(std::uint32_t{0}));
}

}  // namespace flogmap::testing
