// x86-64 with AVX-512 BW, VL and BITALG. Meanings: byte_lanes_portable.hpp.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace flogmap {
namespace {

struct Bytes {
  static constexpr int kLanes = 64;
  __m512i v;
};

inline Bytes load(const std::uint8_t* from) { return {_mm512_loadu_si512(from)}; }
inline void store(std::uint8_t* to, Bytes a) { _mm512_storeu_si512(to, a.v); }
inline Bytes splat(std::uint8_t value) { return {_mm512_set1_epi8(static_cast<char>(value))}; }
inline Bytes add(Bytes a, Bytes b) { return {_mm512_add_epi8(a.v, b.v)}; }
inline Bytes add_saturated(Bytes a, Bytes b) { return {_mm512_adds_epu8(a.v, b.v)}; }
inline Bytes subtract(Bytes a, Bytes b) { return {_mm512_sub_epi8(a.v, b.v)}; }
inline Bytes min(Bytes a, Bytes b) { return {_mm512_min_epu8(a.v, b.v)}; }
inline Bytes max(Bytes a, Bytes b) { return {_mm512_max_epu8(a.v, b.v)}; }
inline Bytes average(Bytes a, Bytes b) { return {_mm512_avg_epu8(a.v, b.v)}; }
inline Bytes bit_and(Bytes a, Bytes b) { return {_mm512_and_si512(a.v, b.v)}; }
inline Bytes bit_or(Bytes a, Bytes b) { return {_mm512_or_si512(a.v, b.v)}; }
inline Bytes bit_xor(Bytes a, Bytes b) { return {_mm512_xor_si512(a.v, b.v)}; }
inline Bytes less(Bytes a, Bytes b) { return {_mm512_movm_epi8(_mm512_cmplt_epu8_mask(a.v, b.v))}; }
inline Bytes select(Bytes mask, Bytes yes, Bytes no) {
  return {_mm512_ternarylogic_epi64(mask.v, yes.v, no.v, 0xCA)};
}
template <int kBits>
Bytes shift_bits_right(Bytes a) {
  return {
      _mm512_and_si512(_mm512_srli_epi16(a.v, kBits), _mm512_set1_epi8(static_cast<char>(0xFF >> kBits)))};
}
inline Bytes popcount(Bytes a) { return {_mm512_popcnt_epi8(a.v)}; }
inline Bytes shift_lanes_up(Bytes a, Bytes before) {
  return {_mm512_alignr_epi8(a.v, _mm512_alignr_epi64(a.v, before.v, 6), 15)};
}
inline Bytes shift_lanes_down(Bytes a, Bytes after) {
  return {_mm512_alignr_epi8(_mm512_alignr_epi64(after.v, a.v, 2), a.v, 1)};
}
inline std::uint8_t first_byte(Bytes a) {
  return static_cast<std::uint8_t>(_mm_cvtsi128_si32(_mm512_castsi512_si128(a.v)));
}
inline Bytes min_everywhere(Bytes a) {
  const __m256i halves = _mm256_min_epu8(_mm512_castsi512_si256(a.v), _mm512_extracti64x4_epi64(a.v, 1));
  const __m128i fours = _mm_min_epu8(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
  const __m128i pairs = _mm_min_epu8(fours, _mm_srli_epi16(fours, 8));
  return {_mm512_broadcastb_epi8(_mm_minpos_epu16(pairs))};
}
inline int first_equal(Bytes a, Bytes value) {
  const std::uint64_t equal = _mm512_cmpeq_epi8_mask(a.v, value.v);
  return equal == 0 ? -1 : __builtin_ctzll(equal);
}

}  // namespace
}  // namespace flogmap
