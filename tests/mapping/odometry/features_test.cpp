#include "mapping/odometry/features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mapping/odometry/patch_alignment.hpp"
#include "textured_room.hpp"

namespace flogmap {
namespace {

using namespace test;

/// A picture of smooth noise whose pixel (x, y) shows the noise at (x + shift, y).
Image<std::uint8_t> noise_picture(const Eigen::Vector2d& shift, double gain = 1, double offset = 0) {
  Image<std::uint8_t> image(200, 160);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double grey = 40 + 150 * value_noise((x + shift.x()) / 6, (y + shift.y()) / 6, 1);
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(gain * grey + offset + 0.5, 0.0, 255.0));
    }
  }
  return image;
}

Image<std::uint8_t> half_turned(const Image<std::uint8_t>& image) {
  Image<std::uint8_t> turned = image;
  std::reverse(turned.pixels.begin(), turned.pixels.end());
  return turned;
}

TEST(Corners, CoverThePictureAndKeepAwayFromItsBorder) {
  const auto image = noise_picture({0, 0});
  const auto corners = detect_corners(image, {.max_corners = 60, .cell_px = 40});
  EXPECT_EQ(corners.size(), 60U);
  std::set<std::pair<int, int>> cells;
  for (const Corner& c : corners) {
    EXPECT_GE(c.px.x(), kCornerBorderPx - 1);
    EXPECT_LE(c.px.x(), static_cast<float>(image.width - kCornerBorderPx));
    cells.insert({static_cast<int>(c.px.x()) / 40, static_cast<int>(c.px.y()) / 40});
  }
  EXPECT_EQ(cells.size(), 20U);
}

TEST(Corners, MoveWithThePictureToAFractionOfAPixel) {
  const auto still = detect_corners(noise_picture({0, 0}), {});
  const auto moved = detect_corners(noise_picture({2.4, -1.3}), {});
  int num_found = 0;
  for (const Corner& c : still) {
    const Eigen::Vector2f expected = c.px - Eigen::Vector2f(2.4F, -1.3F);
    num_found += std::any_of(moved.begin(), moved.end(),
                             [&](const Corner& m) { return (m.px - expected).norm() < 0.5F; });
  }
  EXPECT_GT(num_found, 0.4 * static_cast<double>(still.size())) << "by chance it would be 2 in 100";
}

TEST(Corners, AreNotSeenInPlainOrTinyPictures) {
  EXPECT_TRUE(detect_corners(Image<std::uint8_t>(200, 160, 90), {}).empty());
  EXPECT_TRUE(detect_corners(Image<std::uint8_t>(20, 20, 90), {}).empty());
}

/// Share of the matches that are right when picture `b` shows pixel p of `a` at `b_from_a(p)`.
template <typename Map>
double share_of_right_matches(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b, PatchFrame frame,
                              Map b_from_a) {
  const auto from = detect_corners(a, {}), to = detect_corners(b, {});
  const auto pairs = match_mutually(describe(a, from, frame), describe(b, to, frame), 0.6);
  int right = 0;
  for (const IndexPair& p : pairs)
    right += (b_from_a(from[p.key].px) - to[p.current].px).norm() < 1.5F ? 1 : 0;
  return static_cast<double>(right) / static_cast<double>(from.size());
}

TEST(Descriptors, IgnoreBrightnessAndContrast) {
  const auto same = [](const Eigen::Vector2f& p) { return p; };
  EXPECT_GT(share_of_right_matches(noise_picture({0, 0}), noise_picture({0, 0}, 0.6, 30), PatchFrame::upright,
                                   same),
            0.9);
}

TEST(Descriptors, InTheirOwnOrientationSurviveAHalfTurn) {
  const auto image = noise_picture({0, 0});
  const auto turn = [&](const Eigen::Vector2f& p) {
    return Eigen::Vector2f(static_cast<float>(image.width - 1) - p.x(),
                           static_cast<float>(image.height - 1) - p.y());
  };
  EXPECT_GT(share_of_right_matches(image, half_turned(image), PatchFrame::own_orientation, turn), 0.6);
  EXPECT_LT(share_of_right_matches(image, half_turned(image), PatchFrame::upright, turn), 0.1);
}

TEST(MutualMatches, AreOneToOneAndOrdered) {
  const auto a = noise_picture({0, 0}), b = noise_picture({3, 2});
  const auto pairs = match_mutually(describe(a, detect_corners(a, {}), PatchFrame::upright),
                                    describe(b, detect_corners(b, {}), PatchFrame::upright), 0.6);
  std::set<int> keys, currents;
  for (const IndexPair& p : pairs) {
    keys.insert(p.key);
    currents.insert(p.current);
  }
  EXPECT_EQ(keys.size(), pairs.size());
  EXPECT_EQ(currents.size(), pairs.size());
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end(), [](auto x, auto y) { return x.key < y.key; }));
  EXPECT_TRUE(match_mutually({}, {}, 1).empty());
}

TEST(PatchAlignment, FindsAShiftToAFewHundredthsOfAPixelWhateverTheExposure) {
  const auto a = noise_picture({0, 0}), b = noise_picture({1.37, -0.82}, 0.8, 15);
  int num_found = 0;
  for (const Corner& c : detect_corners(a, {.max_corners = 60})) {
    const Eigen::Vector2d at = c.px.cast<double>();
    if (at.x() < 20 || at.y() < 20 || at.x() > 180 || at.y() > 140) continue;
    const auto found = PatchAligner(a, at).find(b, at, 4);
    if (!found) continue;
    ++num_found;
    EXPECT_LT((found->px - at + Eigen::Vector2d(1.37, -0.82)).norm(), 0.08);
    EXPECT_GT(found->correlation, 0.95);
  }
  EXPECT_GT(num_found, 30);
}

TEST(PatchAlignment, UndoesARotationThatItIsTold) {
  const auto image = noise_picture({0, 0});
  const auto turned = half_turned(image);
  const Eigen::Vector2d at(90, 70), turned_at(image.width - 1 - at.x(), image.height - 1 - at.y());
  const PatchAligner aligner(PatchSource(image, at), -Eigen::Matrix2d::Identity());
  const auto found = aligner.find(turned, turned_at + Eigen::Vector2d(0.7, -0.5), 3);
  ASSERT_TRUE(found);
  EXPECT_LT((found->px - turned_at).norm(), 0.05);
}

TEST(PatchAlignment, FindsNothingInPlainPictures) {
  const Image<std::uint8_t> plain(100, 100, 77);
  EXPECT_FALSE(PatchAligner(plain, {50, 50}).find(plain, {50, 50}, 3));
  EXPECT_FALSE(PatchAligner(plain, {50, 50}).find_in_row(plain, {50, 50}, 3));
}

}  // namespace
}  // namespace flogmap
