#include "mapping/stereo/simd/kernels.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "mapping/stereo/block_matcher.hpp"
#include "mapping/stereo/sgm_matcher.hpp"
#include "tests/mapping/stereo/synthetic_pair.hpp"

namespace flogmap {
namespace {

bool same_bits(const DisparityImage& a, const DisparityImage& b) {
  return a.px.size() == b.px.size() &&
         std::memcmp(a.px.pixels.data(), b.px.pixels.data(), a.px.size() * sizeof(float)) == 0;
}

/// Noise makes every path through the matchers be taken.
RectifiedFrame noisy_pair(std::mt19937& random, int width, int height) {
  RectifiedFrame pair = shifted_pair(random, width, height, 5);
  add_noise(random, 12, pair);
  return pair;
}

TEST(Kernels, EveryInstructionSetGivesTheBitsOfPlainCpp) {
  const KernelMakers makers = available_kernels();
  std::mt19937 random(17);
  for (const int num_disparities : {16, 48, 64, 80, 112, 160, 208, 256}) {
    const RectifiedFrame pair = noisy_pair(random, 61 + num_disparities / 2, 41);
    const StereoOptions options{.num_disparities = num_disparities, .num_threads = 1};
    for (const auto make : {make_sgm_matcher, make_block_matcher}) {
      const DisparityImage reference = make(options, makers.maker[0](num_disparities))->match(pair);
      for (int i = 1; i < makers.count; ++i) {
        const MatchKernels kernels = makers.maker[i](num_disparities);
        EXPECT_TRUE(same_bits(make(options, kernels)->match(pair), reference))
            << kernels.name << " with " << num_disparities << " disparities";
      }
    }
  }
}

TEST(Kernels, TheChosenOnesHoldAllDisparitiesWithTheLeastPadding) {
  const KernelMakers makers = available_kernels();
  for (int num_disparities = 1; num_disparities <= 256; ++num_disparities) {
    const int stride = match_kernels(num_disparities).stride;
    EXPECT_GE(stride, num_disparities);
    for (int i = 1; i < makers.count; ++i) EXPECT_LE(stride, makers.maker[i](num_disparities).stride);
  }
}

}  // namespace
}  // namespace flogmap
