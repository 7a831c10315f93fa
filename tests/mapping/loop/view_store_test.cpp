#include "mapping/loop/view_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace flogmap {
namespace {

/// A slanted surface with steps, holes and noise, and what no disparity can be.
DisparityImage random_disparity(std::mt19937& random, int width, int height) {
  DisparityImage disparity{Image<float>(width, height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float d = 20 + 0.05F * static_cast<float>(x) + (x / 40 % 2 == 0 ? 30.0F : 0.0F);
      d += static_cast<float>(random() % 1000) / 2000;
      if (random() % 7 == 0) d = std::numeric_limits<float>::quiet_NaN();
      disparity.px.at(x, y) = d;
    }
  }
  disparity.px.at(0, 0) = -3;
  disparity.px.at(1, 0) = std::numeric_limits<float>::infinity();
  disparity.px.at(2, 0) = 0;
  disparity.px.at(3, 0) = 1023.9F;
  disparity.px.at(4, 0) = 1.0F / 64;
  return disparity;
}

bool same_bits(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

TEST(ViewStore, RoundedDisparitiesComeBackToTheBit) {
  std::mt19937 random(4);
  for (const auto& [width, height] : {std::pair(320, 60), std::pair(7, 3), std::pair(5, 1)}) {
    const DisparityImage raw = random_disparity(random, width, height);
    DisparityImage rounded = raw;
    round_disparity(rounded);
    const DisparityImage back = unpack_disparity(pack_disparity(raw), width, height);
    ASSERT_EQ(back.px.size(), rounded.px.size());
    for (std::size_t i = 0; i < back.px.size(); ++i) {
      ASSERT_TRUE(same_bits(back.px.pixels[i], rounded.px.pixels[i])) << i;
      const float d = raw.px.pixels[i];
      if (d > 0.1F && d < 1000) {
        ASSERT_LE(std::abs(back.px.pixels[i] - d), 1.0F / 128);
      }
    }
    for (const int none : {0, 1, 2}) EXPECT_TRUE(std::isnan(back.px.pixels[none]));
    EXPECT_EQ(back.px.pixels[4], 1.0F / 64);
  }
}

TEST(ViewStore, DamagedBytesAreRefused) {
  std::mt19937 random(5);
  auto bytes = pack_disparity(random_disparity(random, 40, 30));
  EXPECT_THROW((void)unpack_disparity(bytes, 40, 31), std::invalid_argument);
  bytes.resize(bytes.size() / 2);
  EXPECT_THROW((void)unpack_disparity(bytes, 40, 30), std::invalid_argument);
}

TEST(ViewStore, IsFullOnlyAboveItsBytesAndNeverOfOneView) {
  std::mt19937 random(6);
  View view;
  view.disparity = random_disparity(random, 80, 60);
  ViewStore store(1);
  store.add(view);
  EXPECT_FALSE(store.is_full());
  view.timestamp_ns = 7;
  store.add(view);
  EXPECT_TRUE(store.is_full());
  store.drop_oldest();
  EXPECT_FALSE(store.is_full());
  EXPECT_EQ(store.view(0).timestamp_ns, 7);
  EXPECT_EQ(store.num_bytes(), pack_disparity(view.disparity).size());
}

}  // namespace
}  // namespace flogmap
