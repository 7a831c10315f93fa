#include "mapping/flog/full_confidence.hpp"

#include <gtest/gtest.h>

namespace flogmap {
namespace {

TEST(FullConfidence, IsWhatThePapersCameraGives) {
  const StereoCamera camera{416.8, 159.5, 119.5, 0.07, 320, 240};
  EXPECT_EQ(full_confidence_rays(camera, {0.02, {0, 0.7}}, 32, 2, 1), std::vector<float>{823});
}

TEST(FullConfidence, IsWhatAWideCameraGives) {
  const StereoCamera camera{435, 375.5, 239.5, 0.11, 752, 480};
  EXPECT_EQ(full_confidence_rays(camera, {0.02, {0, 0.7}}, 64, 1, 1), std::vector<float>{4739});
}

TEST(FullConfidence, HasOneValuePerLayerAndIsAtLeastOne) {
  const StereoCamera camera{435, 375.5, 239.5, 0.11, 752, 480};
  const auto rays = full_confidence_rays(camera, {0.02, {0, 0.1, 0.8, 0.801}}, 64, 8, 8);
  ASSERT_EQ(rays.size(), 3U);
  EXPECT_LT(rays[0], rays[1]);
  EXPECT_EQ(rays[2], 1);
}

}  // namespace
}  // namespace flogmap
