// x86-64 with AVX2. Meanings: byte_lanes_portable.hpp.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace flogmap {
namespace {

struct Bytes {
  static constexpr int kLanes = 32;
  __m256i v;
};

inline Bytes load(const std::uint8_t* from) {
  return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))};
}
inline void store(std::uint8_t* to, Bytes a) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), a.v); }
inline Bytes splat(std::uint8_t value) { return {_mm256_set1_epi8(static_cast<char>(value))}; }
inline Bytes add(Bytes a, Bytes b) { return {_mm256_add_epi8(a.v, b.v)}; }
inline Bytes add_saturated(Bytes a, Bytes b) { return {_mm256_adds_epu8(a.v, b.v)}; }
inline Bytes subtract(Bytes a, Bytes b) { return {_mm256_sub_epi8(a.v, b.v)}; }
inline Bytes min(Bytes a, Bytes b) { return {_mm256_min_epu8(a.v, b.v)}; }
inline Bytes max(Bytes a, Bytes b) { return {_mm256_max_epu8(a.v, b.v)}; }
inline Bytes average(Bytes a, Bytes b) { return {_mm256_avg_epu8(a.v, b.v)}; }
inline Bytes bit_and(Bytes a, Bytes b) { return {_mm256_and_si256(a.v, b.v)}; }
inline Bytes bit_or(Bytes a, Bytes b) { return {_mm256_or_si256(a.v, b.v)}; }
inline Bytes bit_xor(Bytes a, Bytes b) { return {_mm256_xor_si256(a.v, b.v)}; }
inline Bytes less(Bytes a, Bytes b) {
  const __m256i b_is_min = _mm256_cmpeq_epi8(_mm256_min_epu8(a.v, b.v), b.v);  // b <= a
  return {_mm256_xor_si256(b_is_min, _mm256_set1_epi8(-1))};
}
inline Bytes select(Bytes mask, Bytes yes, Bytes no) { return {_mm256_blendv_epi8(no.v, yes.v, mask.v)}; }
template <int kBits>
Bytes shift_bits_right(Bytes a) {
  return {
      _mm256_and_si256(_mm256_srli_epi16(a.v, kBits), _mm256_set1_epi8(static_cast<char>(0xFF >> kBits)))};
}
inline Bytes popcount(Bytes a) {
#if defined(__AVX512BITALG__) && defined(__AVX512VL__)
  return {_mm256_popcnt_epi8(a.v)};
#else
  const __m256i count = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,  //
                                         0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m256i low = _mm256_set1_epi8(15);
  return {_mm256_add_epi8(_mm256_shuffle_epi8(count, _mm256_and_si256(a.v, low)),
                          _mm256_shuffle_epi8(count, _mm256_and_si256(_mm256_srli_epi16(a.v, 4), low)))};
#endif
}
inline Bytes shift_lanes_up(Bytes a, Bytes before) {
  return {_mm256_alignr_epi8(a.v, _mm256_permute2x128_si256(before.v, a.v, 0x21), 15)};
}
inline Bytes shift_lanes_down(Bytes a, Bytes after) {
  return {_mm256_alignr_epi8(_mm256_permute2x128_si256(a.v, after.v, 0x21), a.v, 1)};
}
inline std::uint8_t first_byte(Bytes a) {
  return static_cast<std::uint8_t>(_mm_cvtsi128_si32(_mm256_castsi256_si128(a.v)));
}
inline Bytes min_everywhere(Bytes a) {
  const __m128i halves = _mm_min_epu8(_mm256_castsi256_si128(a.v), _mm256_extracti128_si256(a.v, 1));
  const __m128i pairs = _mm_min_epu8(halves, _mm_srli_epi16(halves, 8));
  return {_mm256_broadcastb_epi8(_mm_minpos_epu16(pairs))};
}
inline int first_equal(Bytes a, Bytes value) {
  const int equal = _mm256_movemask_epi8(_mm256_cmpeq_epi8(a.v, value.v));
  return equal == 0 ? -1 : __builtin_ctz(static_cast<unsigned>(equal));
}

}  // namespace
}  // namespace flogmap
