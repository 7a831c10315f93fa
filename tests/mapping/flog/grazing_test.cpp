#include "mapping/flog/grazing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mapping/triangulate.hpp"
#include "tests/support/box_scene.hpp"

namespace flogmap {
namespace {

using namespace test;

constexpr StereoCamera kCamera{180, 155.5, 99.5, 0.11, 312, 200};
constexpr double kDegree = std::numbers::pi / 180;
const GridSpec kHigh{0.02, {-100, 100}};  // every point lies within the layers

View plain_view(float disparity_px) {
  View view;
  view.disparity.px = Image<float>(kCamera.width_px, kCamera.height_px, disparity_px);
  return view;
}

int num_kept(const DisparityImage& disparity) {
  int count = 0;
  for (const float d : disparity.px.pixels) count += d > 0 ? 1 : 0;
  return count;
}

/// A plane through `point` (camera frame, metres), as a perfect matcher sees it.
View view_of_plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point) {
  View view = plain_view(std::nanf(""));
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = 0; x < kCamera.width_px; ++x) {
      const Eigen::Vector3d ray((x - kCamera.cx_px) / kCamera.focal_px,
                                (y - kCamera.cy_px) / kCamera.focal_px, 1);
      const double Z = normal.dot(point) / normal.dot(ray);
      if (Z > 0) view.disparity.px.at(x, y) = static_cast<float>(kCamera.focal_px * kCamera.baseline_m / Z);
    }
  }
  return view;
}

TEST(Grazing, OfAPlaneThoseRaysGoThatMeetItTooMuchFromTheSide) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal_distribution;
  int left_out = 0, kept = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Vector3d normal = Eigen::Vector3d(normal_distribution(random), normal_distribution(random),
                                                   0.3 * normal_distribution(random))
                                       .normalized();
    const View view = view_of_plane(normal, {0.2, -0.1, 2.5});
    const DisparityImage after = without_grazing(kCamera, kHigh, view, 70);
    for (int y = 0; y < kCamera.height_px; ++y) {
      for (int x = 0; x < kCamera.width_px; ++x) {
        const float d = view.disparity.px.at(x, y);
        if (!(d > 0.5F)) continue;  // nearer to the horizon than single precision tells slopes
        const double cosine = std::abs(triangulate(kCamera, x, y, d).normalized().dot(normal));
        const double incidence_deg = std::acos(cosine) / kDegree;
        if (std::abs(incidence_deg - 70) < 0.2) continue;
        const bool is_kept = after.px.at(x, y) > 0;
        ASSERT_EQ(is_kept, incidence_deg < 70) << x << ' ' << y << " at " << incidence_deg;
        ++(is_kept ? kept : left_out);
      }
    }
  }
  EXPECT_GT(left_out, 10'000);
  EXPECT_GT(kept, 10'000);
}

TEST(Grazing, WhatIsKeptKeepsItsDisparity) {
  const View view = seen_from(furnished_room(), kCamera, looking({-2, -1.5, 1.4}, 0.5, -0.2, 0.3));
  const DisparityImage after = without_grazing(kCamera, kHigh, view, 76);
  for (std::size_t i = 0; i < after.px.size(); ++i) {
    if (!(after.px.pixels[i] > 0)) continue;
    ASSERT_EQ(after.px.pixels[i], view.disparity.px.pixels[i]);
  }
  EXPECT_GT(num_kept(after), num_kept(view.disparity) / 2);
  const DisparityImage all = without_grazing(kCamera, kHigh, view, 90);
  EXPECT_EQ(num_kept(all), num_kept(view.disparity));
}

TEST(Grazing, BothSidesOfAStepStay) {
  View view = plain_view(10);
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = 160; x < kCamera.width_px; ++x) view.disparity.px.at(x, y) = 30;
  }
  EXPECT_EQ(num_kept(without_grazing(kCamera, kHigh, view, 60)), kCamera.width_px * kCamera.height_px);
}

TEST(Grazing, AVeilBetweenTwoSurfacesGoes) {
  View view = plain_view(10);
  constexpr int kBegin = 160, kWidth_px = 8;  // a ramp from one surface to the other
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = kBegin; x < kCamera.width_px; ++x) {
      view.disparity.px.at(x, y) =
          static_cast<float>(10 + 20 * std::min(1.0, (x - kBegin) / double{kWidth_px}));
    }
  }
  const DisparityImage after = without_grazing(kCamera, kHigh, view, 76);
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = 0; x < kCamera.width_px; ++x) {
      const bool in_the_veil = x >= kBegin + 2 && x <= kBegin + kWidth_px - 2;
      const bool on_a_surface = x <= kBegin || x >= kBegin + kWidth_px;
      if (in_the_veil) {
        EXPECT_TRUE(std::isnan(after.px.at(x, y))) << x << ' ' << y;
      }
      if (on_a_surface) {
        EXPECT_GT(after.px.at(x, y), 0) << x << ' ' << y;
      }
    }
  }
}

TEST(Grazing, TheFloorBelowTheLayersStaysForAMapThatAsksWhereItIsFree) {
  const BoxScene hall{{{-20, -20, 0}, {20, 20, 4}}, {}};
  const View view = seen_from(hall, kCamera, looking({0, 0, 0.25}, 0.3));  // a low robot
  const GridSpec above_the_floor{0.02, {0.05, 0.75}};
  const DisparityImage after = without_grazing(kCamera, above_the_floor, view, 76);
  const SE3& pose = view.world_from_camera;
  int on_floor = 0;
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = 0; x < kCamera.width_px; ++x) {
      const double d = view.disparity.px.at(x, y);
      if (!(d > 0) || (pose * triangulate(kCamera, x, y, d)).z() > 0.01) continue;
      ASSERT_GT(after.px.at(x, y), 0) << x << ' ' << y;
      ++on_floor;
    }
  }
  EXPECT_GT(on_floor, 10'000);
  EXPECT_LT(num_kept(without_grazing(kCamera, kHigh, view, 76)), num_kept(after) - 1000)
      << "else nothing was tried";
}

}  // namespace
}  // namespace flogmap
