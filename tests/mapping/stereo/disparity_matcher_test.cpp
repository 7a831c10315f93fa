#include "mapping/stereo/disparity_matcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapping/stereo/segment_filter.hpp"
#include "tests/mapping/stereo/synthetic_pair.hpp"

namespace flogmap {
namespace {

constexpr int kBorderPx = 6;  // windows reach out of the picture there

/// Both matchers obey the same laws.
class Matcher : public testing::TestWithParam<MatcherKind> {
 protected:
  static DisparityImage match(const RectifiedFrame& pair, int num_disparities = 32, int min_disparity = 0,
                              int num_threads = 1) {
    return make_matcher({.matcher = GetParam(),
                         .min_disparity = min_disparity,
                         .num_disparities = num_disparities,
                         .num_threads = num_threads},
                        {})
        ->match(pair);
  }

  std::mt19937 random_{42};
};

INSTANTIATE_TEST_SUITE_P(BothKinds, Matcher, testing::Values(MatcherKind::block, MatcherKind::sgm),
                         [](const auto& kind) { return kind.param == MatcherKind::block ? "block" : "sgm"; });

bool same_bits(const DisparityImage& a, const DisparityImage& b) {
  return a.px.size() == b.px.size() &&
         std::memcmp(a.px.pixels.data(), b.px.pixels.data(), a.px.size() * sizeof(float)) == 0;
}

double share_valid(const DisparityImage& d) {
  double valid = 0;
  for (const float value : d.px.pixels) valid += !std::isnan(value);
  return valid / static_cast<double>(d.px.size());
}

TEST_P(Matcher, RecoversAShiftedTextureExactlyWhereverTheRightPictureShowsIt) {
  for (const int shift : {1, 7, 18}) {
    const DisparityImage d = match(shifted_pair(random_, 97, 63, shift));
    for (int y = 0; y < d.px.height; ++y) {
      for (int x = shift + kBorderPx; x < d.px.width; ++x)
        EXPECT_NEAR(d.px.at(x, y), shift, 0.25F) << x << ',' << y;
    }
  }
}

TEST_P(Matcher, NothingIsAnsweredWhereTheMatchLiesOutsideTheRightPicture) {
  const DisparityImage d = match(shifted_pair(random_, 97, 63, 18));
  for (int y = 0; y < d.px.height; ++y) {
    for (int x = 0; x < d.px.width; ++x) {
      if (std::isnan(d.px.at(x, y))) continue;
      EXPECT_GE(static_cast<float>(x) - d.px.at(x, y), -0.5F);
    }
  }
}

TEST_P(Matcher, TheRangeBeginsAtMinDisparity) {
  const DisparityImage far = match(shifted_pair(random_, 97, 63, 40), 32, 24);
  const DisparityImage behind = match(shifted_pair(random_, 97, 63, -5), 32, -16);
  for (int y = 0; y < 63; ++y) {
    for (int x = 40 + kBorderPx; x < 97; ++x) EXPECT_NEAR(far.px.at(x, y), 40, 0.25F);
    for (int x = 0; x < 97 - 5 - kBorderPx; ++x) EXPECT_NEAR(behind.px.at(x, y), -5, 0.25F);
  }
}

TEST_P(Matcher, ASlantedPlaneIsMeasuredWithoutBiasAndWithLittlePixelLocking) {
  const auto plane = [](int x, int y) { return 9 + 0.06 * x + 0.035 * y; };
  const DisparityImage d = match(pair_of_surface(random_, 240, 120, plane));
  std::vector<double> sum(8, 0), count(8, 0);
  for (int y = kBorderPx; y < 120 - kBorderPx; ++y) {
    for (int x = 40; x < 240 - kBorderPx; ++x) {
      if (std::isnan(d.px.at(x, y))) continue;
      const double truth = plane(x, y);
      const auto eighth = static_cast<std::size_t>((truth - std::floor(truth)) * 8);
      sum[eighth] += d.px.at(x, y) - truth, ++count[eighth];
    }
  }
  const double most = GetParam() == MatcherKind::sgm ? 0.06 : 0.12;
  double bias = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    ASSERT_GT(count[i], 1000);
    EXPECT_NEAR(sum[i] / count[i], 0, most) << "at " << static_cast<double>(i) / 8 << " px";
    bias += sum[i] / count[i] / 8;
  }
  EXPECT_NEAR(bias, 0, 0.02);
}

TEST_P(Matcher, OccludedPixelsStayInvalidAndNeitherSurfaceBleedsFar) {
  const BoxPair pair = box_pair(random_, 200, 120, 20, 5);
  const DisparityImage d = match(pair.frame);
  int occluded = 0, answered = 0, wrong = 0, seen = 0;
  for (int y = kBorderPx; y < 120 - kBorderPx; ++y) {
    for (int x = 40; x < 200 - kBorderPx; ++x) {
      const bool valid = !std::isnan(d.px.at(x, y));
      if (pair.occluded(x, y)) {
        ++occluded, answered += valid;
      } else if (valid) {
        ++seen, wrong += std::abs(d.px.at(x, y) - static_cast<float>(pair.on_box(x, y) ? 20 : 5)) > 1;
      }
    }
  }
  EXPECT_LT(answered, 0.3 * occluded);
  EXPECT_LT(wrong, 0.02 * seen);
}

TEST_P(Matcher, AMirrorExchangesLeftAndRight) {
  const BoxPair pair = box_pair(random_, 200, 120, 20, 5);
  const DisparityImage d = match(pair.frame), in_mirror = match(mirrored(pair.frame));
  int both = 0, same = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (std::isnan(d.px.at(x, y))) continue;
      const auto right_x = static_cast<int>(std::lround(static_cast<float>(x) - d.px.at(x, y)));
      if (right_x < 0 || std::isnan(in_mirror.px.at(199 - right_x, y))) continue;
      ++both, same += std::abs(in_mirror.px.at(199 - right_x, y) - d.px.at(x, y)) < 0.5F;
    }
  }
  EXPECT_GT(both, 15'000);
  EXPECT_GT(same, 0.97 * both);
}

TEST_P(Matcher, AUniformPictureHasNoDisparity) {
  for (const std::uint8_t grey : {std::uint8_t{0}, std::uint8_t{128}, std::uint8_t{255}}) {
    const Image<std::uint8_t> flat(80, 60, grey);
    EXPECT_EQ(share_valid(match({0, flat, flat})), 0) << static_cast<int>(grey);
  }
}

/// What the map would see: 0.15 % of the picture is the smallest patch.
double share_valid_after_filter(DisparityImage d) {
  remove_small_segments(d, static_cast<int>(0.0015 * static_cast<double>(d.px.size())));
  return share_valid(d);
}

TEST_P(Matcher, UnrelatedPicturesLeaveHardlyAnyAnswer) {
  const RectifiedFrame one = shifted_pair(random_, 320, 240, 3), other = shifted_pair(random_, 320, 240, 3);
  EXPECT_LT(share_valid_after_filter(match({0, one.left, other.right}, 64)), 0.1);
}

TEST_P(Matcher, AVerticalOffsetShowsAsMissingAnswers) {
  const RectifiedFrame pair = shifted_pair(random_, 320, 240, 8);
  RectifiedFrame shifted = pair;
  for (int y = 0; y < 240; ++y) {
    std::copy(pair.right.row(std::max(0, y - 5)), pair.right.row(std::max(0, y - 5)) + 320,
              shifted.right.row(y));
  }
  EXPECT_GT(share_valid_after_filter(match(pair, 64)), 0.9);
  EXPECT_LT(share_valid_after_filter(match(shifted, 64)), 0.1);
}

TEST_P(Matcher, ExposureAndNoiseOfTheRightCameraHardlyMatter) {
  RectifiedFrame pair = shifted_pair(random_, 160, 120, 8);
  for (std::uint8_t& grey : pair.right.pixels) grey = static_cast<std::uint8_t>(20 + grey * 0.7);
  add_noise(random_, 4, pair);
  const DisparityImage d = match(pair);
  int good = 0, all = 0;
  for (int y = kBorderPx; y < 120 - kBorderPx; ++y) {
    for (int x = 8 + kBorderPx; x < 160 - kBorderPx; ++x) ++all, good += std::abs(d.px.at(x, y) - 8) < 0.5F;
  }
  EXPECT_GT(good, 0.98 * all);
}

TEST_P(Matcher, SaturatedRegionsAreLeftOutOrRight) {
  RectifiedFrame pair = shifted_pair(random_, 160, 120, 8);
  for (Image<std::uint8_t>* image : {&pair.left, &pair.right}) {
    for (std::uint8_t& grey : image->pixels) grey = static_cast<std::uint8_t>(std::min(255, grey * 2));
  }
  const DisparityImage d = match(pair);
  int wrong = 0, valid = 0;
  for (const float value : d.px.pixels) valid += !std::isnan(value), wrong += std::abs(value - 8) > 1;
  EXPECT_GT(valid, 0.7 * 160 * 120);
  EXPECT_LT(wrong, 0.01 * valid);
}

TEST_P(Matcher, AnySizeFromOnePixelOnIsMatched) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 40}, {40, 1}, {2, 2}, {33, 3}, {5, 77}, {161, 121}}) {
    const RectifiedFrame pair = shifted_pair(random_, width, height, 1);
    for (const int num_disparities : {1, 16, 100, 256}) {
      const DisparityImage d = match(pair, num_disparities);
      EXPECT_EQ(d.px.width, width);
      EXPECT_EQ(d.px.height, height);
    }
  }
  EXPECT_TRUE(match({}).px.empty());
}

TEST_P(Matcher, AnswersDoNotDependOnTheNumberOfThreadsOrOnWhatCameBefore) {
  RectifiedFrame pair = shifted_pair(random_, 150, 333, 9);
  add_noise(random_, 15, pair);
  const DisparityImage once = match(pair, 48, 0, 1);
  for (const int num_threads : {2, 3, 7}) EXPECT_TRUE(same_bits(match(pair, 48, 0, num_threads), once));
  const auto matcher = make_matcher({.matcher = GetParam(), .num_disparities = 48, .num_threads = 2}, {});
  matcher->match(shifted_pair(random_, 260, 410, 3));
  EXPECT_TRUE(same_bits(matcher->match(pair), once));
}

TEST_P(Matcher, AnswersLieInTheRange) {
  RectifiedFrame pair = shifted_pair(random_, 150, 90, 9);
  add_noise(random_, 60, pair);
  for (const float value : match(pair, 24, 3).px.pixels) {
    if (std::isnan(value)) continue;
    EXPECT_THAT(value, testing::AllOf(testing::Ge(3), testing::Lt(3 + 32)));
  }
}

TEST(StereoOptions, AutomaticRangeReachesDownToTheNearestDistance) {
  const StereoCamera euroc{
      .focal_px = 435, .cx_px = 0, .cy_px = 0, .baseline_m = 0.11, .width_px = 752, .height_px = 480};
  EXPECT_EQ(auto_num_disparities(euroc, 0.5, 0), 96);
  EXPECT_EQ(auto_num_disparities(euroc, 0.5, 32), 64);
  EXPECT_EQ(auto_num_disparities(euroc, 1e9, 0), 16);
  const StereoCamera street{
      .focal_px = 721, .cx_px = 0, .cy_px = 0, .baseline_m = 0.537, .width_px = 1242, .height_px = 375};
  EXPECT_EQ(auto_num_disparities(street, 0.5, 0), 256);
}

TEST(StereoOptions, AnImpossibleValueIsNamedWithWhatIsAllowed) {
  const auto message = [](const StereoOptions& options) -> std::string {
    try {
      check(options);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({}), "");
  EXPECT_THAT(message({.num_disparities = -3}),
              testing::AllOf(testing::HasSubstr("num-disparities"), testing::HasSubstr("-3")));
  EXPECT_THAT(message({.nearest_m = 0}), testing::HasSubstr("nearest must be > 0"));
  EXPECT_THAT(message({.min_segment_fraction = 1.5}), testing::HasSubstr("[0, 1)"));
  EXPECT_THAT(message({.num_threads = -1}), testing::HasSubstr("threads"));
}

}  // namespace
}  // namespace flogmap
