#include "mapping/flog/view_selector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace flogmap {
namespace {

constexpr StereoCamera kCamera{400, 319.5, 239.5, 0.1, 640, 480};

SE3 pose(double x_m, double turned_rad = 0, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  SE3 world_from_camera = SE3::Identity();
  world_from_camera.translate(Eigen::Vector3d(x_m, 0, 0)).rotate(Eigen::AngleAxisd(turned_rad, axis));
  return world_from_camera;
}

TEST(ViewSelector, TakesTheFirstViewAndNoneFromTheSamePlace) {
  ViewSelector selector({}, kCamera);
  EXPECT_TRUE(selector.accept(pose(1)));
  EXPECT_FALSE(selector.accept(pose(1)));
  selector.reset();
  EXPECT_TRUE(selector.accept(pose(1)));
}

TEST(ViewSelector, MeasuresTheWayFromTheLastAcceptedView) {
  ViewSelector selector({}, kCamera);  // four cells of 20 mm
  int accepted = 0;
  for (int i = 0; i <= 100; ++i) accepted += selector.accept(pose(0.01 * i)) ? 1 : 0;
  EXPECT_EQ(accepted, 13);  // at 0, 0.08, 0.16 ... 0.96
}

TEST(ViewSelector, TakesAViewTurnedMoreThanHalfTheFieldOfViewAboutAnyAxis) {
  const double half = std::atan(320.0 / 400);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d{0, 0, 1}, {0, 1, 0}, {0.6, 0, 0.8}}) {
    ViewSelector selector({}, kCamera);
    EXPECT_TRUE(selector.accept(pose(0)));
    EXPECT_FALSE(selector.accept(pose(0, half - 1e-3, axis)));
    EXPECT_TRUE(selector.accept(pose(0, -half - 1e-3, axis)));
  }
}

TEST(ViewSelector, MetresWinOverCells) {
  ViewSelectorOptions options;
  options.translation_m = 0.5;
  ViewSelector selector(options, kCamera);
  EXPECT_TRUE(selector.accept(pose(0)));
  EXPECT_FALSE(selector.accept(pose(0.49)));
  EXPECT_TRUE(selector.accept(pose(0.5)));
}

TEST(ViewSelector, RefusesImpossibleOptions) {
  ViewSelectorOptions options;
  options.translation_cells = 0;
  EXPECT_THROW(ViewSelector(options, kCamera), std::invalid_argument);
}

}  // namespace
}  // namespace flogmap
