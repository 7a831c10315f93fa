#include "mapping/flog/cell_fuse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace flogmap {
namespace {

constexpr float kStep = 1.0F / kMembershipScale;

struct Saying {
  double mu_E, mu_O;
};

std::vector<Saying> random_view(std::mt19937& random, int rays) {
  std::uniform_real_distribution<double> membership(0, 1);
  std::vector<Saying> view;
  for (int i = 0; i < rays; ++i) {
    const double E = membership(random);
    view.push_back({E, (1 - E) * membership(random)});
  }
  return view;
}

CellEvidence sum_of(const std::vector<Saying>& view) {
  CellEvidence sum{static_cast<std::uint32_t>(view.size()), 0, 0};
  for (const Saying& s : view) {
    sum.empty += s.mu_E;
    sum.occupied += s.mu_O;
  }
  return sum;
}

TEST(Fuse, IsTheMeanOfAllRaysBelowTheCap) {
  std::mt19937 random(1);
  const std::vector<Saying> rays = random_view(random, 100);
  ExactCell cell;
  for (const Saying& s : rays) fuse(cell, s.mu_E, s.mu_O, 300);
  const CellEvidence sum = sum_of(rays);
  EXPECT_EQ(cell.N, 100);
  EXPECT_NEAR(cell.E, sum.empty / 100, 1e-12);
  EXPECT_NEAR(cell.O, sum.occupied / 100, 1e-12);
}

TEST(Fuse, AtTheCapEveryRayWeighsOneInN_f) {
  ExactCell cell{0.25, 0.5, 300};
  fuse(cell, 1, 0, 300);
  EXPECT_EQ(cell.N, 300);
  EXPECT_NEAR(cell.E, 0.25 + 0.75 / 300, 1e-12);
  EXPECT_NEAR(cell.O, 0.5 - 0.5 / 300, 1e-12);
}

TEST(Fuse, ABatchEqualsItsRaysOneByOneBelowTheCap) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const double N_K = 1000;
    Cell cell;
    ExactCell exact;
    for (int views = 0; views < 5; ++views) {
      const auto view = random_view(random, 1 + trial * 2);
      const Cell before = cell;
      exact = {mu_E(before), mu_O(before), double(before.rays)};
      for (const Saying& s : view) fuse(exact, s.mu_E, s.mu_O, max_rays(N_K));
      CellMerger(N_K).merge(cell, sum_of(view));
      EXPECT_EQ(cell.rays, exact.N);
      EXPECT_NEAR(mu_E(cell), exact.E, kStep);
      EXPECT_NEAR(mu_O(cell), exact.O, kStep);
    }
  }
}

TEST(Fuse, ABatchBeyondTheCapEqualsRaysThatAllSayTheMean) {
  std::mt19937 random(3);
  for (const int already : {0, 1, 100, 299, 300}) {
    for (const int n : {1, 2, 50, 300, 301, 5000}) {
      const auto sum = sum_of(random_view(random, n));
      Cell cell{20000, 30000, static_cast<std::uint16_t>(already), 0};
      if (already == 0) cell = Cell{};
      ExactCell exact{mu_E(cell), mu_O(cell), double(already)};
      for (int i = 0; i < n; ++i) fuse(exact, sum.empty / n, sum.occupied / n, 300);
      CellMerger(100).merge(cell, sum);
      EXPECT_EQ(cell.rays, std::min(already + n, 300));
      EXPECT_NEAR(mu_E(cell), exact.E, kStep) << already << " rays, then " << n;
      EXPECT_NEAR(mu_O(cell), exact.O, kStep) << already << " rays, then " << n;
    }
  }
}

TEST(Fuse, TheOrderOfViewsDoesNotMatterBelowTheCap) {
  std::mt19937 random(4);
  std::vector<CellEvidence> views;
  for (int i = 0; i < 8; ++i) views.push_back(sum_of(random_view(random, 20 + 10 * i)));
  Cell forth, back;
  for (const auto& view : views) CellMerger(1000).merge(forth, view);
  std::reverse(views.begin(), views.end());
  for (const auto& view : views) CellMerger(1000).merge(back, view);
  EXPECT_EQ(forth.rays, back.rays);
  EXPECT_NEAR(mu_E(forth), mu_E(back), 8 * kStep);
  EXPECT_NEAR(mu_O(forth), mu_O(back), 8 * kStep);
}

TEST(Fuse, EvidenceStaysAPartOfOne) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> count(1, 2000);
  std::uniform_real_distribution<double> share(0, 1);
  Cell cell;
  const CellMerger merger(700);
  for (int i = 0; i < 5000; ++i) {
    const auto n = static_cast<std::uint32_t>(count(random));
    const double E = share(random) * n;
    merger.merge(cell, {n, E, n - E});
    ASSERT_LE(cell.empty + cell.occupied, 65535);
    ASSERT_NEAR(mu_E(cell) + mu_O(cell), 1, 2 * kStep);
  }
}

TEST(Confidence, GrowsWithTheRaysUpToOne) {
  EXPECT_EQ(confidence(Cell{0, 0, 0, 0}, 100), 0);
  EXPECT_FLOAT_EQ(confidence(Cell{0, 0, 25, 0}, 100), 0.25F);
  EXPECT_EQ(confidence(Cell{0, 0, 250, 0}, 100), 1);
}

TEST(MaxRays, IsThreeTimesFullConfidenceWithinSixteenBits) {
  EXPECT_EQ(max_rays(823), 2469);
  EXPECT_EQ(max_rays(1), 3);
  EXPECT_EQ(max_rays(40'000), 65535);
}

TEST(Change, IsHowFarAViewContradictsAKnownCell) {
  Cell cell{65535, 0, 50, 0};  // known to be empty; N_K / 8 is 12.5
  CellMerger(100).merge(cell, {10, 0, 10});
  EXPECT_NEAR(cell.change, 65535, 1);
}

TEST(Change, NeedsACellThatWasKnownBefore) {
  Cell cell{65535, 0, 12, 0};
  CellMerger(100).merge(cell, {10, 0, 10});
  EXPECT_EQ(cell.change, 0);
}

TEST(Change, FadesByAnEighthWithEveryViewThatAgrees) {
  Cell cell{65535, 0, 200, 64000};
  CellMerger(100).merge(cell, {10, 10, 0});
  EXPECT_EQ(cell.change, 56000);
  CellMerger(100).merge(cell, {10, 10, 0});
  EXPECT_EQ(cell.change, 49000);
}

}  // namespace
}  // namespace flogmap
