#include "mapping/stereo/border_correction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/mapping/stereo/synthetic_pair.hpp"

namespace flogmap {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kSize = 64, kNear = 20, kFar = 6, kEdge = 40;  // the near surface ends before kEdge

/// A bright near surface beside a dark far wall; `transposed`: above it.
class BorderCorrection : public testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] bool near(int x, int y) const { return (GetParam() ? y : x) < kEdge; }

  /// Both surfaces are plain but for a little noise, so that nothing but the border tells them apart.
  RectifiedFrame pair() {
    RectifiedFrame out{0, Image<std::uint8_t>(kSize, kSize), Image<std::uint8_t>(kSize, kSize, 60)};
    std::uniform_int_distribution<int> noise(-2, 2);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        out.left.at(x, y) = static_cast<std::uint8_t>((near(x, y) ? 180 : 60) + noise(random_));
        if (near(x + kNear, y)) out.right.at(x, y) = 180;
      }
    }
    return out;
  }

  /// The near surface reaches `smeared` px beyond its border (less than 0: falls short of it).
  [[nodiscard]] static DisparityImage smeared(int smeared) {
    DisparityImage out{Image<float>(kSize, kSize)};
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) out.px.at(x, y) = (GetParam() ? y : x) < kEdge + smeared ? kNear : kFar;
    }
    return out;
  }

  /// Without the columns that the right picture does not show.
  static bool same_where_seen(const DisparityImage& a, const DisparityImage& b) {
    for (int y = 0; y < kSize; ++y) {
      if (!std::equal(a.px.row(y) + kNear, a.px.row(y) + kSize, b.px.row(y) + kNear)) return false;
    }
    return true;
  }

  std::mt19937 random_{11};
};

TEST_P(BorderCorrection, MovesASmearedEdgeBackToTheBorder) {
  const RectifiedFrame seen = pair();
  for (int smear = 1; smear <= 5; ++smear) {
    DisparityImage disparity = smeared(smear);
    correct_borders(disparity, seen);
    EXPECT_TRUE(same_where_seen(disparity, smeared(0))) << smear << " px";
  }
}

TEST_P(BorderCorrection, LeavesWhatIsRightOrTooFarOff) {
  const RectifiedFrame seen = pair();
  for (const int smear : {0, 6, 9}) {
    DisparityImage disparity = smeared(smear);
    correct_borders(disparity, seen);
    EXPECT_EQ(disparity.px, smeared(smear).px) << smear << " px";
  }
}

TEST_P(BorderCorrection, LeavesAnEdgeWhereThePictureHasNone) {
  RectifiedFrame seen = pair();
  for (Image<std::uint8_t>* image : {&seen.left, &seen.right}) {
    std::fill(image->pixels.begin(), image->pixels.end(), std::uint8_t{90});
  }
  DisparityImage disparity = smeared(3);
  correct_borders(disparity, seen);
  EXPECT_EQ(disparity.px, smeared(3).px);
}

TEST_P(BorderCorrection, LeavesAStripeThatMatchesAsNear) {
  // The near surface has a stripe of another brightness at its border; at the wall's disparity it does not
  // match.
  RectifiedFrame seen = pair();
  DisparityImage disparity = smeared(3);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto striped = [&](int u) {
        return (GetParam() ? y : u) >= kEdge && (GetParam() ? y : u) < kEdge + 3;
      };
      if (striped(x)) seen.left.at(x, y) = 120;
      if (striped(x + kNear)) seen.right.at(x, y) = 120;
    }
  }
  correct_borders(disparity, seen);
  EXPECT_TRUE(same_where_seen(disparity, smeared(3)));
}

TEST_P(BorderCorrection, NothingIsInvented) {
  const RectifiedFrame seen = pair();
  std::uniform_int_distribution<int> any(0, 3);
  DisparityImage disparity = smeared(3);
  for (float& d : disparity.px.pixels) {
    if (any(random_) == 0) d = kNone;
  }
  const DisparityImage before = disparity;
  correct_borders(disparity, seen);
  for (std::size_t i = 0; i < before.px.size(); ++i) {
    const float was = before.px.pixels[i], is = disparity.px.pixels[i];
    EXPECT_EQ(std::isnan(was), std::isnan(is));
    EXPECT_TRUE(std::isnan(was) || is == was || (was == kNear && is == kFar));
  }
}

INSTANTIATE_TEST_SUITE_P(RightAndBelow, BorderCorrection, testing::Bool());

TEST(BorderCorrectionOddSizes, SinglePixelsRowsAndColumns) {
  for (const auto& [width, height] : {std::pair{0, 0}, {1, 1}, {7, 1}, {1, 7}}) {
    const RectifiedFrame pair{0, Image<std::uint8_t>(width, height), Image<std::uint8_t>(width, height)};
    DisparityImage disparity{Image<float>(width, height, 3.0F)};
    if (!disparity.px.empty()) disparity.px.pixels.back() = 9;
    const DisparityImage before = disparity;
    correct_borders(disparity, pair);
    EXPECT_EQ(disparity.px, before.px);
  }
}

}  // namespace
}  // namespace flogmap
