#include "camera/low_bits.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace flogmap {
namespace {

constexpr unsigned kLargest = 65535;
constexpr std::size_t kBytes = sizeof(std::uint16_t);

std::uint16_t value_at(const Picture& picture, std::size_t index) {
  std::uint16_t value = 0;
  std::memcpy(&value, picture.bytes.data() + kBytes * index, kBytes);
  return value;
}

}  // namespace

int unused_bits(const Picture& picture) {
  if (picture.bits != 16) return 0;
  constexpr unsigned kTenBits = 1U << 10, kTwelveBits = 1U << 12;
  unsigned largest = 0;
  for (std::size_t i = 0; i < picture.bytes.size() / kBytes && largest < kTwelveBits; ++i)
    largest = std::max<unsigned>(largest, value_at(picture, i));
  if (largest < kTenBits) return 6;
  return largest < kTwelveBits ? 4 : 0;
}

void shift_up(Picture& picture, int bits) {
  if (picture.bits != 16 || bits == 0) return;
  for (std::size_t i = 0; i < picture.bytes.size() / kBytes; ++i) {
    const unsigned shifted = static_cast<unsigned>(value_at(picture, i)) << bits;
    const auto value = static_cast<std::uint16_t>(std::min(shifted, kLargest));
    std::memcpy(picture.bytes.data() + kBytes * i, &value, kBytes);
  }
}

}  // namespace flogmap
