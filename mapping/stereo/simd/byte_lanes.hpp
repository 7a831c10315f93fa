// One native register of unsigned bytes, and the dozen operations the matchers are made of.
// Included once per instruction set (kernels_*.cpp); everything stays in that file's anonymous namespace and
// nothing of the standard library's inline code is used, so that no AVX code can leak into other files.
// Every version gives the same bits.
#pragma once

#if defined(FLOGMAP_PORTABLE_LANES)
#include "mapping/stereo/simd/byte_lanes_portable.hpp"
#elif defined(__AVX512BITALG__) && defined(__AVX512BW__)
#include "mapping/stereo/simd/byte_lanes_avx512.hpp"
#elif defined(__AVX2__)
#include "mapping/stereo/simd/byte_lanes_avx2.hpp"
#elif defined(__SSE2__)
#include "mapping/stereo/simd/byte_lanes_sse.hpp"
#elif defined(__ARM_NEON) && defined(__aarch64__)
#include "mapping/stereo/simd/byte_lanes_neon.hpp"
#else
#include "mapping/stereo/simd/byte_lanes_portable.hpp"
#endif
