// arm64. Meanings: byte_lanes_portable.hpp.
#pragma once

#include <arm_neon.h>

#include <cstdint>

namespace flogmap {
namespace {

struct Bytes {
  static constexpr int kLanes = 16;
  uint8x16_t v;
};

inline Bytes load(const std::uint8_t* from) { return {vld1q_u8(from)}; }
inline void store(std::uint8_t* to, Bytes a) { vst1q_u8(to, a.v); }
inline Bytes splat(std::uint8_t value) { return {vdupq_n_u8(value)}; }
inline Bytes add(Bytes a, Bytes b) { return {vaddq_u8(a.v, b.v)}; }
inline Bytes add_saturated(Bytes a, Bytes b) { return {vqaddq_u8(a.v, b.v)}; }
inline Bytes subtract(Bytes a, Bytes b) { return {vsubq_u8(a.v, b.v)}; }
inline Bytes min(Bytes a, Bytes b) { return {vminq_u8(a.v, b.v)}; }
inline Bytes max(Bytes a, Bytes b) { return {vmaxq_u8(a.v, b.v)}; }
inline Bytes average(Bytes a, Bytes b) { return {vrhaddq_u8(a.v, b.v)}; }
inline Bytes bit_and(Bytes a, Bytes b) { return {vandq_u8(a.v, b.v)}; }
inline Bytes bit_or(Bytes a, Bytes b) { return {vorrq_u8(a.v, b.v)}; }
inline Bytes bit_xor(Bytes a, Bytes b) { return {veorq_u8(a.v, b.v)}; }
inline Bytes less(Bytes a, Bytes b) { return {vcltq_u8(a.v, b.v)}; }
inline Bytes select(Bytes mask, Bytes yes, Bytes no) { return {vbslq_u8(mask.v, yes.v, no.v)}; }
template <int kBits>
Bytes shift_bits_right(Bytes a) {
  return {vshrq_n_u8(a.v, kBits)};
}
inline Bytes popcount(Bytes a) { return {vcntq_u8(a.v)}; }
inline Bytes shift_lanes_up(Bytes a, Bytes before) { return {vextq_u8(before.v, a.v, 15)}; }
inline Bytes shift_lanes_down(Bytes a, Bytes after) { return {vextq_u8(a.v, after.v, 1)}; }
inline std::uint8_t first_byte(Bytes a) { return vgetq_lane_u8(a.v, 0); }
inline Bytes min_everywhere(Bytes a) { return splat(vminvq_u8(a.v)); }
inline int first_equal(Bytes a, Bytes value) {
  // Four bits per lane remain after narrowing: arm has no movemask.
  const uint8x8_t nibbles = vshrn_n_u16(vreinterpretq_u16_u8(vceqq_u8(a.v, value.v)), 4);
  const std::uint64_t equal = vget_lane_u64(vreinterpret_u64_u8(nibbles), 0);
  return equal == 0 ? -1 : __builtin_ctzll(equal) / 4;
}

}  // namespace
}  // namespace flogmap
