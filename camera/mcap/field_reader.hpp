#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace flogmap::mcap {

using ByteView = std::span<const std::uint8_t>;

/// Reads fields one after the other out of bytes that may end anywhere or hold anything. Past the end every
/// number is zero, every text empty, and ok() is false from then on: readers look once, at their end.
class FieldReader {
 public:
  /// How numbers and texts lie in the bytes. As it stands: MCAP's own records and ROS 1; CDR differs.
  struct Layout {
    bool big_endian = false;
    std::size_t max_alignment = 1;       // a number begins at a multiple of its size, at most of this
    bool texts_end_with_a_null = false;  // and count it
  };

  explicit FieldReader(ByteView bytes) : bytes_(bytes) {}
  FieldReader(ByteView bytes, Layout layout) : bytes_(bytes), layout_(layout) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
  [[nodiscard]] std::size_t position() const { return position_; }

  template <typename T>
  [[nodiscard]] T number() {
    const std::size_t step = std::min(sizeof(T), layout_.max_alignment);
    (void)bytes((step - position_ % step) % step);
    const ByteView raw = bytes(sizeof(T));
    std::array<std::uint8_t, sizeof(T)> ordered{};
    std::copy(raw.begin(), raw.end(), ordered.begin());
    static_assert(std::endian::native == std::endian::little);
    if (layout_.big_endian) std::reverse(ordered.begin(), ordered.end());
    T value{};
    std::memcpy(&value, ordered.data(), sizeof(T));
    return value;
  }

  /// The next bytes as they are; nothing if there are fewer.
  [[nodiscard]] ByteView bytes(std::uint64_t count) {
    if (!ok_ || count > left()) {
      ok_ = false;
      return {};
    }
    const ByteView taken = bytes_.subspan(position_, count);
    position_ += count;
    return taken;
  }
  [[nodiscard]] ByteView rest() { return bytes(left()); }

  /// Bytes after their number, which has 32 bits.
  [[nodiscard]] ByteView counted_bytes() { return bytes(number<std::uint32_t>()); }

  [[nodiscard]] std::string_view text() {
    const ByteView raw = counted_bytes();
    const bool null = layout_.texts_end_with_a_null && !raw.empty() && raw.back() == 0;
    return {reinterpret_cast<const char*>(raw.data()), raw.size() - (null ? 1 : 0)};
  }

 private:
  ByteView bytes_;
  Layout layout_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace flogmap::mcap
