// Rows that do not belong together are told.
#include "mapping/stereo/row_offset.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/stereo/synthetic_pair.hpp"

namespace flogmap {
namespace {

/// Smooth in both directions, so that rows can be told apart by fractions.
Image<std::uint8_t> blurred_down(const Image<std::uint8_t>& image) {
  Image<std::uint8_t> out = image;
  for (int y = 1; y + 1 < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      out.at(x, y) =
          static_cast<std::uint8_t>((image.at(x, y - 1) + 2 * image.at(x, y) + image.at(x, y + 1)) / 4);
  }
  return out;
}

/// The right picture `rows` lower than it should be, darker, at one disparity.
RectifiedFrame pair_with_offset(int rows) {
  std::mt19937 random(7);
  RectifiedFrame pair = shifted_pair(random, 320, 240, 12);
  pair.left = blurred_down(pair.left);
  const Image<std::uint8_t> right = blurred_down(pair.right);
  for (int y = 0; y < right.height; ++y) {
    for (int x = 0; x < right.width; ++x)
      pair.right.at(x, y) =
          static_cast<std::uint8_t>(right.at(x, std::clamp(y - rows, 0, right.height - 1)) * 0.9);
  }
  return pair;
}

TEST(RowOffset, IsTheOneTheRightPictureHas) {
  for (const int rows : {-5, -2, -1, 0, 1, 3, 5}) {
    const auto offset = measure_row_offset(pair_with_offset(rows), 0, 32);
    ASSERT_TRUE(offset) << rows;
    EXPECT_NEAR(offset->median_px, rows, 0.1) << rows;
    EXPECT_GE(offset->num_matches, 25) << rows;
  }
}

TEST(RowOffset, IsNotGuessedFromBarePictures) {
  RectifiedFrame pair{0, Image<std::uint8_t>(320, 240), Image<std::uint8_t>(320, 240)};
  EXPECT_FALSE(measure_row_offset(pair, 0, 32));
  for (int y = 0; y < 240; ++y) {  // upright stripes say nothing about rows
    for (int x = 0; x < 320; ++x) pair.left.at(x, y) = pair.right.at(x, y) = x / 7 % 2 ? 200 : 40;
  }
  EXPECT_FALSE(measure_row_offset(pair, 0, 32));
}

TEST(RowOffset, IsNotGuessedFromPicturesOfDifferentThings) {
  std::mt19937 random(8);
  RectifiedFrame pair = shifted_pair(random, 320, 240, 5);
  pair.right = shifted_pair(random, 320, 240, 5).right;
  EXPECT_FALSE(measure_row_offset(pair, 0, 32));
}

TEST(RowOffset, NeedsNoParticularSize) {
  for (const auto& [width, height] : {std::pair{0, 0}, {1, 1}, {40, 1}, {1, 40}, {41, 43}}) {
    const RectifiedFrame pair{0, Image<std::uint8_t>(width, height), Image<std::uint8_t>(width, height)};
    EXPECT_FALSE(measure_row_offset(pair, 0, 64));
  }
}

TEST(RowOffset, IsPutIntoWordsOnlyWhereItHurts) {
  EXPECT_EQ(words_of_row_offset(std::nullopt), "");
  EXPECT_EQ(words_of_row_offset(-0.7), "");
  EXPECT_NE(words_of_row_offset(-2.34).find("2.3 px higher"), std::string::npos);
  EXPECT_NE(words_of_row_offset(2.34).find("2.3 px lower"), std::string::npos);
}

TEST(RowWatch, SpeaksOfTheMiddleOfThreeMeasuredPairs) {
  RowWatch watch(0, 32);
  const RectifiedFrame good = pair_with_offset(0), bad = pair_with_offset(3);
  std::optional<double> said;
  for (int i = 0; i < 64; ++i) EXPECT_FALSE(watch.add(good));
  for (int i = 0; i < 64; ++i) EXPECT_FALSE(watch.add(bad));
  for (int i = 0; i < 64; ++i) said = watch.add(bad);
  ASSERT_TRUE(said);
  EXPECT_NEAR(*said, 3, 0.1);
  watch.reset();
  EXPECT_FALSE(watch.add(good));
}

}  // namespace
}  // namespace flogmap
