// Compiles a function for several instruction sets and picks one at run time, where the compiler can: x86-64
// with GCC. No fused multiply-add among them: the pictures are the same on every machine.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define FLOGMAP_PICTURE_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define FLOGMAP_PICTURE_CLONES
#endif
