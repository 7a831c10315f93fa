// x86-64: SSE2, and SSSE3 / SSE4.1 where the file is compiled for them. Meanings: byte_lanes_portable.hpp.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace flogmap {
namespace {

struct Bytes {
  static constexpr int kLanes = 16;
  __m128i v;
};

inline Bytes load(const std::uint8_t* from) {
  return {_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))};
}
inline void store(std::uint8_t* to, Bytes a) { _mm_storeu_si128(reinterpret_cast<__m128i*>(to), a.v); }
inline Bytes splat(std::uint8_t value) { return {_mm_set1_epi8(static_cast<char>(value))}; }
inline Bytes add(Bytes a, Bytes b) { return {_mm_add_epi8(a.v, b.v)}; }
inline Bytes add_saturated(Bytes a, Bytes b) { return {_mm_adds_epu8(a.v, b.v)}; }
inline Bytes subtract(Bytes a, Bytes b) { return {_mm_sub_epi8(a.v, b.v)}; }
inline Bytes min(Bytes a, Bytes b) { return {_mm_min_epu8(a.v, b.v)}; }
inline Bytes max(Bytes a, Bytes b) { return {_mm_max_epu8(a.v, b.v)}; }
inline Bytes average(Bytes a, Bytes b) { return {_mm_avg_epu8(a.v, b.v)}; }
inline Bytes bit_and(Bytes a, Bytes b) { return {_mm_and_si128(a.v, b.v)}; }
inline Bytes bit_or(Bytes a, Bytes b) { return {_mm_or_si128(a.v, b.v)}; }
inline Bytes bit_xor(Bytes a, Bytes b) { return {_mm_xor_si128(a.v, b.v)}; }
inline Bytes less(Bytes a, Bytes b) {
  const __m128i b_is_min = _mm_cmpeq_epi8(_mm_min_epu8(a.v, b.v), b.v);  // b <= a
  return {_mm_xor_si128(b_is_min, _mm_set1_epi8(-1))};
}
inline Bytes select(Bytes mask, Bytes yes, Bytes no) {
  return {_mm_or_si128(_mm_and_si128(mask.v, yes.v), _mm_andnot_si128(mask.v, no.v))};
}
template <int kBits>
Bytes shift_bits_right(Bytes a) {
  return {_mm_and_si128(_mm_srli_epi16(a.v, kBits), _mm_set1_epi8(static_cast<char>(0xFF >> kBits)))};
}
inline Bytes popcount(Bytes a) {
#if defined(__SSSE3__)
  const __m128i count = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m128i low = _mm_set1_epi8(15);
  return {_mm_add_epi8(_mm_shuffle_epi8(count, _mm_and_si128(a.v, low)),
                       _mm_shuffle_epi8(count, _mm_and_si128(_mm_srli_epi16(a.v, 4), low)))};
#else
  const Bytes pairs = subtract(a, bit_and(shift_bits_right<1>(a), splat(0x55)));
  const Bytes fours = add(bit_and(pairs, splat(0x33)), bit_and(shift_bits_right<2>(pairs), splat(0x33)));
  return bit_and(add(fours, shift_bits_right<4>(fours)), splat(0x0F));
#endif
}
inline Bytes shift_lanes_up(Bytes a, Bytes before) {
  return {_mm_or_si128(_mm_slli_si128(a.v, 1), _mm_srli_si128(before.v, 15))};
}
inline Bytes shift_lanes_down(Bytes a, Bytes after) {
  return {_mm_or_si128(_mm_srli_si128(a.v, 1), _mm_slli_si128(after.v, 15))};
}
inline std::uint8_t first_byte(Bytes a) { return static_cast<std::uint8_t>(_mm_cvtsi128_si32(a.v)); }
inline Bytes min_everywhere(Bytes a) {
#if defined(__SSE4_1__)
  const __m128i pairs = _mm_min_epu8(a.v, _mm_srli_epi16(a.v, 8));
  return {_mm_shuffle_epi8(_mm_minpos_epu16(pairs), _mm_setzero_si128())};
#else
  __m128i m = _mm_min_epu8(a.v, _mm_shuffle_epi32(a.v, _MM_SHUFFLE(1, 0, 3, 2)));
  m = _mm_min_epu8(m, _mm_shuffle_epi32(m, _MM_SHUFFLE(2, 3, 0, 1)));
  m = _mm_min_epu8(m, _mm_or_si128(_mm_srli_epi32(m, 16), _mm_slli_epi32(m, 16)));
  return {_mm_min_epu8(m, _mm_or_si128(_mm_srli_epi16(m, 8), _mm_slli_epi16(m, 8)))};
#endif
}
inline int first_equal(Bytes a, Bytes value) {
  const int equal = _mm_movemask_epi8(_mm_cmpeq_epi8(a.v, value.v));
  return equal == 0 ? -1 : __builtin_ctz(static_cast<unsigned>(equal));
}

}  // namespace
}  // namespace flogmap
