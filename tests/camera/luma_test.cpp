// Grey from what sensors deliver.
#include "camera/live/luma.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace flogmap {
namespace {

TEST(Luma, StridesAreHonoured) {
  std::vector<std::uint8_t> bytes(8 * 3, 255);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x)
      bytes[static_cast<std::size_t>(8 * y + x)] = static_cast<std::uint8_t>(10 * y + x);
  }
  const Picture grey = grey_from_plane({bytes.data(), bytes.size(), 8, 4, 3}, LumaLayout::planar8);
  EXPECT_THAT(grey.bytes, ::testing::ElementsAre(0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23));
}

TEST(Luma, YuyvAndPackedTenBitsGiveTheirUpperEightBits) {
  const std::vector<std::uint8_t> yuyv{1, 128, 2, 128, 3, 128, 4, 128};
  EXPECT_THAT(grey_from_plane({yuyv.data(), yuyv.size(), 8, 4, 1}, LumaLayout::interleaved8).bytes,
              ::testing::ElementsAre(1, 2, 3, 4));
  const std::vector<std::uint8_t> packed{1, 2, 3, 4, 0xE4, 5, 6, 7, 8, 0x1B};
  EXPECT_THAT(grey_from_plane({packed.data(), packed.size(), 10, 8, 1}, LumaLayout::packed10).bytes,
              ::testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
}

TEST(Luma, AMosaicOfOneColourIsFlatGreyInAllFourOrders) {
  // Red 200, green 100, blue 40: every 2x2 block holds one red, two green, one blue.
  for (int order = 0; order < 4; ++order) {
    std::vector<std::uint8_t> mosaic;
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 6; ++x) {
        const int colour = ((y + order / 2) % 2) * 2 + (x + order) % 2;
        mosaic.push_back(colour == 0 ? 200 : colour == 3 ? 40 : 100);
      }
    }
    EXPECT_THAT(grey_from_plane({mosaic.data(), mosaic.size(), 6, 6, 6}, LumaLayout::bayer8).bytes,
                ::testing::Each(110));
  }
}

TEST(Luma, APlaneThatIsTooSmallGivesNoPicture) {
  const std::vector<std::uint8_t> bytes(100);
  for (const LumaLayout layout : {LumaLayout::planar8, LumaLayout::interleaved8, LumaLayout::packed10,
                                  LumaLayout::bayer8, LumaLayout::bayer10}) {
    EXPECT_TRUE(grey_from_plane({bytes.data(), bytes.size(), 16, 16, 16}, layout).empty());
    EXPECT_TRUE(grey_from_plane({bytes.data(), bytes.size(), 4, 16, 2}, layout).empty());
    EXPECT_TRUE(grey_from_plane({bytes.data(), bytes.size(), 16, 0, 2}, layout).empty());
  }
}

TEST(Luma, EveryLayoutIsKnownByLibcamerasName) {
  EXPECT_EQ(luma_layout("NV12"), LumaLayout::planar8);
  EXPECT_EQ(luma_layout("R10_CSI2P"), LumaLayout::packed10);
  EXPECT_EQ(luma_layout("SBGGR10_CSI2P"), LumaLayout::bayer10);
  EXPECT_FALSE(luma_layout("MJPEG"));
}

}  // namespace
}  // namespace flogmap
