// Up is where gravity is felt at rest.
#include "camera/inertial_up.hpp"

#include <gtest/gtest.h>

namespace flogmap {
namespace {

TEST(InertialUp, IsTheMeanOfTheRestingStart) {
  const Eigen::Vector3d gravity = 9.81 * Eigen::Vector3d(0.1, -0.99, 0.1).normalized();
  std::vector<Acceleration> samples;
  for (int i = 0; i < 400; ++i) {
    const double shake = i % 2 ? 0.8 : -0.8;
    const double start = i > 250 ? 3.0 : 0.0;  // the camera is taken up
    samples.push_back({i / 200.0, gravity + Eigen::Vector3d(shake, 0, start)});
  }
  const auto up = resting_acceleration(samples);
  ASSERT_TRUE(up);
  EXPECT_LT((up->normalized() - gravity.normalized()).norm(), 0.003);
}

TEST(InertialUp, SaysNothingWhenTheStartIsNoRest) {
  std::vector<Acceleration> moving, falling, brief;
  for (int i = 0; i < 400; ++i) {
    moving.push_back({i / 200.0, Eigen::Vector3d(0.02 * i, 9.81, 0)});
    falling.push_back({i / 200.0, Eigen::Vector3d(0, 2, 0)});
    if (i < 50) brief.push_back({i / 200.0, Eigen::Vector3d(0, 9.81, 0)});
  }
  EXPECT_FALSE(resting_acceleration(moving));
  EXPECT_FALSE(resting_acceleration(falling));
  EXPECT_FALSE(resting_acceleration(brief));
  EXPECT_FALSE(resting_acceleration({}));
}

}  // namespace
}  // namespace flogmap
