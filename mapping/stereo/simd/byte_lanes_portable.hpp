// Plain C++: the reference for the other versions, and the way on machines without one.
#pragma once

#include <cstdint>

namespace flogmap {
namespace {

struct Bytes {
  static constexpr int kLanes = 16;
  std::uint8_t lane[kLanes];
};

template <typename Operation>
Bytes lanewise(const Bytes& a, const Bytes& b, Operation operation) {
  Bytes out;
  for (int i = 0; i < Bytes::kLanes; ++i)
    out.lane[i] = static_cast<std::uint8_t>(operation(a.lane[i], b.lane[i]));
  return out;
}

inline Bytes load(const std::uint8_t* from) {
  Bytes out;
  for (int i = 0; i < Bytes::kLanes; ++i) out.lane[i] = from[i];
  return out;
}
inline void store(std::uint8_t* to, Bytes a) {
  for (int i = 0; i < Bytes::kLanes; ++i) to[i] = a.lane[i];
}
inline Bytes splat(std::uint8_t value) {
  Bytes out;
  for (std::uint8_t& lane : out.lane) lane = value;
  return out;
}
inline Bytes add(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x + y; });
}
inline Bytes add_saturated(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x + y > 255 ? 255 : x + y; });
}
inline Bytes subtract(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x - y; });
}
inline Bytes min(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x < y ? x : y; });
}
inline Bytes max(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x > y ? x : y; });
}
inline Bytes average(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return (x + y + 1) >> 1; });
}
inline Bytes bit_and(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x & y; });
}
inline Bytes bit_or(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x | y; });
}
inline Bytes bit_xor(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x ^ y; });
}
inline Bytes less(Bytes a, Bytes b) {
  return lanewise(a, b, [](int x, int y) { return x < y ? 255 : 0; });
}
inline Bytes select(Bytes mask, Bytes yes, Bytes no) {
  Bytes out;
  for (int i = 0; i < Bytes::kLanes; ++i) out.lane[i] = mask.lane[i] ? yes.lane[i] : no.lane[i];
  return out;
}
template <int kBits>
Bytes shift_bits_right(Bytes a) {
  for (std::uint8_t& lane : a.lane) lane = static_cast<std::uint8_t>(lane >> kBits);
  return a;
}
inline Bytes popcount(Bytes a) {
  for (std::uint8_t& lane : a.lane) lane = static_cast<std::uint8_t>(__builtin_popcount(lane));
  return a;
}
/// Lane i takes lane i-1; lane 0 takes the last lane of `before`.
inline Bytes shift_lanes_up(Bytes a, Bytes before) {
  Bytes out;
  out.lane[0] = before.lane[Bytes::kLanes - 1];
  for (int i = 1; i < Bytes::kLanes; ++i) out.lane[i] = a.lane[i - 1];
  return out;
}
/// Lane i takes lane i+1; the last lane takes lane 0 of `after`.
inline Bytes shift_lanes_down(Bytes a, Bytes after) {
  Bytes out;
  out.lane[Bytes::kLanes - 1] = after.lane[0];
  for (int i = 0; i + 1 < Bytes::kLanes; ++i) out.lane[i] = a.lane[i + 1];
  return out;
}
inline std::uint8_t first_byte(Bytes a) { return a.lane[0]; }
/// The least lane, in every lane.
inline Bytes min_everywhere(Bytes a) {
  std::uint8_t least = a.lane[0];
  for (const std::uint8_t lane : a.lane) least = lane < least ? lane : least;
  return splat(least);
}
/// Number of the first lane equal to `value`; -1 if there is none.
inline int first_equal(Bytes a, Bytes value) {
  for (int i = 0; i < Bytes::kLanes; ++i) {
    if (a.lane[i] == value.lane[i]) return i;
  }
  return -1;
}

}  // namespace
}  // namespace flogmap
