// SHA-256, whole for digests of maps and cut to 64 bits as the checksum of a row.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flogmap {

/// Numbers as little-endian bytes, so that files and digests are the same on every machine.
class LittleEndianBytes {
 public:
  LittleEndianBytes& add(std::uint64_t value);
  LittleEndianBytes& add_signed(std::int64_t value) { return add(static_cast<std::uint64_t>(value)); }
  /// IEEE 754, 8 bytes; -0 becomes 0.
  LittleEndianBytes& add(double value);
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }
  [[nodiscard]] std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// The number whose 8 little-endian bytes begin at `at`.
std::uint64_t little_endian_u64(std::span<const std::uint8_t> bytes, std::size_t at);
double little_endian_double(std::span<const std::uint8_t> bytes, std::size_t at);

class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept = default;
  Sha256& operator=(Sha256&&) noexcept = default;
  ~Sha256();
  Sha256& add(std::span<const std::uint8_t> bytes);
  Sha256& add(std::string_view text);
  /// 64 hex digits.
  std::string hex();
  /// The first 8 bytes as a little-endian number.
  std::uint64_t number();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace flogmap
