// Writes MCAP files and the messages in them, for the tests of their reader; shares no code with it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "camera/calibration/ros_calibration.hpp"
#include "camera/image.hpp"

namespace flogmap::testing {

/// Puts fields behind one another, as MCAP, CDR and ROS 1 each want them.
class FieldWriter {
 public:
  FieldWriter() = default;
  FieldWriter(bool big_endian, std::size_t max_alignment, bool nulls)
      : big_endian_(big_endian), max_alignment_(max_alignment), nulls_(nulls) {}

  template <typename T>
  FieldWriter& number(T value) {
    const std::size_t step = std::min(sizeof(T), max_alignment_);
    while (text_.size() % step != 0) text_ += '\0';
    const auto* raw = reinterpret_cast<const char*>(&value);
    std::string bytes(raw, sizeof(T));
    if (big_endian_) bytes.assign(bytes.rbegin(), bytes.rend());
    text_ += bytes;
    return *this;
  }
  FieldWriter& raw(std::string_view bytes) {
    text_ += bytes;
    return *this;
  }
  FieldWriter& counted(std::string_view bytes) {
    return number(static_cast<std::uint32_t>(bytes.size())).raw(bytes);
  }
  FieldWriter& text(std::string_view value) {
    return counted(nulls_ ? std::string(value) + '\0' : std::string(value));
  }
  [[nodiscard]] const std::string& bytes() const { return text_; }

 private:
  std::string text_;
  bool big_endian_ = false;
  std::size_t max_alignment_ = 1;
  bool nulls_ = false;
};

struct McapLayout {
  std::string compression{};  // "", "lz4", "zstd"
  bool chunks = true;
  bool summary = true;  // of channels, chunks and counts; false: only a footer
  bool checksums = true;
  int messages_per_chunk = 4;
};

class McapWriter {
 public:
  explicit McapWriter(McapLayout layout = {});

  int add_channel(const std::string& topic, const std::string& schema, const std::string& encoding);
  void add_message(int channel, std::uint64_t log_time_ns, const std::string& data);
  /// Writes the chunk so far, even if it is not full.
  void end_chunk();
  /// A record as it stands, outside of chunks.
  void add_record(std::uint8_t opcode, const std::string& content);
  /// The file so far, as a killed recorder leaves it.
  [[nodiscard]] const std::string& unfinished() const { return file_; }
  /// The whole file.
  [[nodiscard]] std::string finish();

 private:
  static std::string record(std::uint8_t opcode, const std::string& content);
  std::string indexes() const;

  McapLayout layout_;
  std::string file_, definitions_, chunk_, chunk_indexes_;
  std::uint64_t chunk_start_ns_ = 0, chunk_end_ns_ = 0;
  int in_chunk_ = 0;
  std::uint32_t num_chunks_ = 0;
  std::uint16_t num_channels_ = 0;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::map<std::uint16_t, std::string> index_entries_;  // of the chunk
};

enum class Dialect : std::uint8_t { cdr_little, cdr_big, ros1, foxglove };

/// How a dialect calls its types: of "Image", "CompressedImage" and "CameraInfo".
[[nodiscard]] std::string schema_name(Dialect dialect, const std::string& type);
[[nodiscard]] std::string encoding_name(Dialect dialect);

/// A picture as it lies in a message.
struct SentImage {
  std::int64_t stamp_ns = 0;
  std::string encoding = "mono8";
  std::uint32_t width = 0, height = 0, step = 0;
  bool big_endian = false;  // of 16 bits
  std::string data;
};
[[nodiscard]] SentImage sent(const Picture& picture, std::int64_t stamp_ns,
                             const std::string& encoding = "mono8", std::uint32_t padding = 0);
[[nodiscard]] std::string image_message(Dialect dialect, const SentImage& image);
[[nodiscard]] std::string compressed_message(Dialect dialect, std::int64_t stamp_ns,
                                             const std::string& format, const std::string& data);
[[nodiscard]] std::string info_message(Dialect dialect, const RosCameraInfo& info);

}  // namespace flogmap::testing
