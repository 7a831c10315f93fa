// Loops compiled for several instruction sets, the best of which is picked when the program starts.
#pragma once

// The sanitizers are not ready yet when the picking is done; other compilers and machines use their baseline.
// Without FMA contraction (see CMakeLists.txt) every variant gives the same bits.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define FLOGMAP_SIMD_CLONES __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#else
#define FLOGMAP_SIMD_CLONES
#endif
