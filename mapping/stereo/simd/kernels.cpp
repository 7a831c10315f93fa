#include "mapping/stereo/simd/kernels.hpp"

namespace flogmap {

MatchKernels match_kernels_portable(int num_disparities);
MatchKernels match_kernels_native(int num_disparities);
#if defined(__x86_64__)
MatchKernels match_kernels_sse4(int num_disparities);
MatchKernels match_kernels_avx2(int num_disparities);
MatchKernels match_kernels_avx512(int num_disparities);
#endif

KernelMakers available_kernels() {
  KernelMakers all{{match_kernels_portable, match_kernels_native}, 2};
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("sse4.2")) all.maker[all.count++] = match_kernels_sse4;
  if (__builtin_cpu_supports("avx2")) all.maker[all.count++] = match_kernels_avx2;
  if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bitalg")) {
    all.maker[all.count++] = match_kernels_avx512;
  }
#endif
  return all;
}

MatchKernels match_kernels(int num_disparities) {
  const KernelMakers all = available_kernels();
  MatchKernels best = all.maker[all.count - 1](num_disparities);
  for (int i = all.count - 2; i > 0; --i) {  // 0 is the plain reference
    const MatchKernels narrower = all.maker[i](num_disparities);
    if (narrower.stride < best.stride) best = narrower;
  }
  return best;
}

}  // namespace flogmap
