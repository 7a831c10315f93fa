// Grey is the same, however a camera's values are stored: 8, 10, 12 or 16 bits, grey or colour.
#include "camera/low_bits.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <random>

#include "camera/grey.hpp"
#include "tests/camera/recording_folder.hpp"

namespace flogmap {
namespace {

using ::testing::HasSubstr;
using testing::kPeriod;
using testing::Recordings;

constexpr unsigned kSeed = 20261123;

Picture deep_picture(const std::vector<unsigned>& values, int width, int height, int channels = 1) {
  Picture picture{width, height, channels, 16, std::vector<std::uint8_t>(2 * values.size())};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<std::uint16_t>(values[i]);
    std::memcpy(picture.bytes.data() + 2 * i, &value, sizeof value);
  }
  return picture;
}

/// Random tones of 8 bits, among them black and white.
std::vector<unsigned> tones(unsigned seed, int count = 32 * 24) {
  std::mt19937 random(seed);
  std::vector<unsigned> result;
  for (int i = 0; i < count; ++i) result.push_back(random() % 256);
  result[0] = 0, result[1] = 255;
  return result;
}

std::vector<unsigned> times_power_of_two(std::vector<unsigned> values, int bits) {
  for (unsigned& value : values) value <<= bits;
  return values;
}

TEST(LowBits, EveryDepthGivesTheSameGrey) {
  const std::vector<unsigned> eight = tones(kSeed);
  for (const int bits : {10, 12, 16}) {
    Picture picture = deep_picture(times_power_of_two(eight, bits - 8), 32, 24);
    shift_up(picture, unused_bits(picture));
    const Image<std::uint8_t> grey = to_grey(picture);
    for (std::size_t i = 0; i < eight.size(); ++i)
      ASSERT_NEAR(grey.pixels[i], eight[i], 0) << bits << " bits, pixel " << i;
  }
}

TEST(LowBits, ShiftingTwiceIsShiftingOnce) {  // what is recorded and read again stays as it is
  for (const unsigned largest : {300U, 1023U, 1024U, 4095U, 4096U, 65535U}) {
    Picture picture = deep_picture({0, largest / 2, largest}, 3, 1);
    shift_up(picture, unused_bits(picture));
    EXPECT_EQ(unused_bits(picture), 0) << largest;
  }
}

TEST(LowBits, WhatExceedsTheRangeStaysBright) {
  Picture picture = deep_picture({5000, 4095, 1}, 3, 1);
  shift_up(picture, 4);
  EXPECT_EQ(picture, deep_picture({65535, 65520, 16}, 3, 1));
}

TEST(LowBits, EightBitPicturesAreLeftAlone) {
  const Picture dark = testing::grey_picture(1);
  Picture picture = dark;
  EXPECT_EQ(unused_bits(picture), 0);
  shift_up(picture, 4);
  EXPECT_EQ(picture, dark);
}

/// A recording in every form that pictures are stored in gives the grey that was put in.
class PictureForms : public Recordings,
                     public ::testing::WithParamInterface<std::tuple<int, int, const char*>> {};

TEST_P(PictureForms, GiveTheGreyThatWasPutIn) {
  const auto [bits, channels, extension] = GetParam();
  for (const char* camera : {"cam0", "cam1"}) {
    std::string csv;
    for (int i = 0; i < 5; ++i) {
      std::vector<unsigned> values;
      for (const unsigned tone : tones(kSeed + static_cast<unsigned>(i))) {
        for (int c = 0; c < channels; ++c)
          values.push_back(c == 3 ? (1U << bits) - 1 : tone << (bits - 8));  // the fourth is opaqueness
      }
      Picture picture = deep_picture(values, 32, 24, channels);
      if (bits == 8) {
        picture.bits = 8;
        picture.bytes.assign(values.begin(), values.end());
      }
      const std::string name = testing::stamp(i) + extension;
      ASSERT_TRUE(write_picture(folder_.path() / "mav0" / camera / "data" / name, picture));
      csv += testing::stamp(i) + "," + name + "\n";
    }
    folder_.write(std::string("mav0/") + camera + "/data.csv", csv);
  }
  const auto source = open();
  EXPECT_THAT(source->info().assumed,
              bits == 10 || bits == 12 ? HasSubstr(std::to_string(bits) + " bits") : HasSubstr(""));
  for (int i = 0; i < 5; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    const std::vector<unsigned> expected = tones(kSeed + static_cast<unsigned>(i));
    for (const Picture* picture : {&frame->left, &frame->right}) {
      const Image<std::uint8_t> grey = to_grey(*picture);
      ASSERT_EQ(grey.pixels.size(), expected.size());
      for (std::size_t p = 0; p < expected.size(); ++p)
        ASSERT_EQ(grey.pixels[p], expected[p]) << "pixel " << p;
    }
  }
  EXPECT_EQ(source->skipped().count, 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, PictureForms,
    ::testing::Values(std::tuple(8, 1, ".png"), std::tuple(8, 3, ".png"), std::tuple(8, 4, ".png"),
                      std::tuple(10, 1, ".png"), std::tuple(12, 1, ".png"), std::tuple(16, 1, ".png"),
                      std::tuple(16, 3, ".png"), std::tuple(12, 3, ".png"), std::tuple(8, 1, ".pgm"),
                      std::tuple(12, 1, ".pgm"), std::tuple(16, 1, ".pgm"), std::tuple(8, 3, ".ppm"),
                      std::tuple(8, 1, ".tiff"), std::tuple(16, 1, ".tiff"), std::tuple(8, 1, ".bmp")));

TEST_F(Recordings, ADarkStartOfADeepRecordingStaysDark) {
  for (const char* camera : {"cam0", "cam1"}) {
    for (int i = 0; i < 5; ++i)
      ASSERT_TRUE(write_picture(picture(camera, i),
                                deep_picture(std::vector<unsigned>(32 * 24, i < 2 ? 500 : 50'000), 32, 24)));
  }
  const auto source = open();
  EXPECT_EQ(source->info().assumed, "");
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(to_grey(source->next()->left).pixels[0], i < 2 ? 2 : 195, 1);
}

TEST_F(Recordings, GreyAndColourMayTakeTurns) {
  const std::vector<std::uint8_t> colour(32 * 24 * 3, 20);
  ASSERT_TRUE(write_picture(picture("cam0", 2), {32, 24, 3, 8, colour}));
  const auto source = open();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(to_grey(source->next()->left).pixels[100], 10 * i);
  EXPECT_EQ(source->skipped().count, 0);
}

}  // namespace
}  // namespace flogmap
