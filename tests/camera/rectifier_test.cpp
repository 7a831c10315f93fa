// Laws of rectification, for every lens: rows are epipolar, the picture is filled, the camera is the one it
// says.
#include "camera/rectifier.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "camera/calibration/distortion.hpp"

namespace flogmap {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Lens {
  const char* name;
  Distortion distortion;
  double focal_px;
  std::vector<double> coefficients;
};

class EveryLens : public ::testing::TestWithParam<Lens> {
 protected:
  static CameraIntrinsics camera(double off_px) {
    const Lens& lens = GetParam();
    return {640,
            480,
            lens.focal_px + off_px,
            lens.focal_px - off_px,
            322 - 3 * off_px,
            236 + 2 * off_px,
            lens.distortion,
            lens.coefficients};
  }
  static StereoCalibration pair() {
    StereoCalibration calibration;
    calibration.left = camera(0);
    calibration.right = camera(1.7);
    calibration.right_from_left.rotate(Eigen::AngleAxisd(0.03, Vector3d(0.5, 1, -0.4).normalized()));
    calibration.right_from_left.translation() = Vector3d(-0.12, 0.004, 0.006);
    calibration.origin = "test";
    return calibration;
  }
};

TEST_P(EveryLens, PixelsBecomeRaysAndRaysPixels) {
  for (int y = 0; y < 480; y += 37) {
    for (int x = 0; x < 640; x += 41) {
      const auto ray = ray_from_pixel(camera(0), {x, y});
      ASSERT_TRUE(ray) << x << ", " << y;
      EXPECT_LT((pixel_from_ray(camera(0), *ray) - Vector2d(x, y)).norm(), 1e-7);
    }
  }
}

/// A round blot, darkest in its middle.
void draw_blot(Picture& picture, const Vector2d& middle) {
  for (int y = static_cast<int>(middle.y()) - 9; y <= middle.y() + 9; ++y) {
    for (int x = static_cast<int>(middle.x()) - 9; x <= middle.x() + 9; ++x) {
      const double ink = 200 * std::exp(-(Vector2d(x, y) - middle).squaredNorm() / 5);
      std::uint8_t& grey = picture.bytes[y * picture.width + x];
      grey = static_cast<std::uint8_t>(std::max(0.0, grey - ink));
    }
  }
}

Vector2d find_blot(const Image<std::uint8_t>& image, const Vector2d& near) {
  Vector2d sum = Vector2d::Zero();
  double weight = 0;
  for (int y = static_cast<int>(near.y()) - 7; y <= near.y() + 7; ++y) {
    for (int x = static_cast<int>(near.x()) - 7; x <= near.x() + 7; ++x) {
      if (!image.contains(x, y)) continue;
      const double ink = std::max(0, 215 - image.at(x, y));
      sum += ink * Vector2d(x, y);
      weight += ink;
    }
  }
  return sum / weight;
}

Picture white_picture() { return {640, 480, 1, 8, std::vector<std::uint8_t>(640 * 480, 220)}; }

Vector2d project(const StereoCamera& camera, const Vector3d& p) {
  return {camera.focal_px * p.x() / p.z() + camera.cx_px, camera.focal_px * p.y() / p.z() + camera.cy_px};
}

TEST_P(EveryLens, RowsAreEpipolarAndPointsLieWhereTheCameraSays) {
  const StereoCalibration calibration = pair();
  const Rectifier rectifier(calibration);
  const StereoCamera& camera = rectifier.camera();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  int tried = 0;
  while (tried < 60) {
    const Vector2d at(30 + 580 * uniform(random), 30 + 420 * uniform(random));
    const double depth_m = 0.6 + 4 * uniform(random);
    const Vector3d in_rectified((at.x() - camera.cx_px) / camera.focal_px * depth_m,
                                (at.y() - camera.cy_px) / camera.focal_px * depth_m, depth_m);
    const Vector3d in_left = rectifier.rectified_from_raw_left().inverse() * in_rectified;
    const Vector2d left_px = pixel_from_ray(calibration.left, in_left);
    const Vector2d right_px = pixel_from_ray(calibration.right, calibration.right_from_left * in_left);
    const auto inside = [](const Vector2d& p) {
      return p.x() > 10 && p.y() > 10 && p.x() < 629 && p.y() < 469;
    };
    const Vector2d expected_right = project(camera, in_rectified - Vector3d(camera.baseline_m, 0, 0));
    if (!inside(left_px) || !inside(right_px) || !inside(expected_right)) continue;
    ++tried;
    StereoFrame frame{1, white_picture(), white_picture()};
    draw_blot(frame.left, left_px);
    draw_blot(frame.right, right_px);
    const RectifiedFrame rectified = rectifier.rectify(frame);
    const Vector2d left = find_blot(rectified.left, at), right = find_blot(rectified.right, expected_right);
    EXPECT_NEAR(left.y(), right.y(), 0.1);
    EXPECT_LT((left - at).norm(), 0.2);  // a blot is warped a little, its middle with it
    EXPECT_LT((right - expected_right).norm(), 0.2);
  }
}

TEST_P(EveryLens, BothPicturesAreFilledToTheirBorders) {
  Picture framed = white_picture();
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (std::min({x, y, 639 - x, 479 - y}) < 2)
        framed.bytes[y * 640 + x] = 0;  // seen only if the border is
    }
  }
  const RectifiedFrame rectified = Rectifier(pair()).rectify({1, framed, framed});
  for (const auto* image : {&rectified.left, &rectified.right}) {
    const auto dark =
        std::count_if(image->pixels.begin(), image->pixels.end(), [](int grey) { return grey < 100; });
    EXPECT_LT(dark, 2300);  // a line of two pixels along the whole border has 4456
  }
}

TEST_P(EveryLens, TheRawAxesAreOnlyTurned) {
  const Rectifier rectifier(pair());
  EXPECT_TRUE(rectifier.rectified_from_raw_left().translation().isZero());
  EXPECT_NEAR(rectifier.rectified_from_raw_left().linear().determinant(), 1, 1e-12);
  EXPECT_NEAR(rectifier.camera().baseline_m, pair().right_from_left.translation().norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, EveryLens,
    ::testing::Values(
        Lens{"none", Distortion::none, 420, {}},
        Lens{"radtan", Distortion::radtan, 400, {-0.2834, 0.0739, 0.00019, 1.76e-05}},
        Lens{"radtan5", Distortion::radtan, 520, {0.08, -0.12, 0.0005, -0.0004, 0.03}},
        Lens{"rational", Distortion::rational, 430, {0.3, 0.05, 0.0003, -0.0002, 0.0, 0.6, 0.02, 0.0}},
        Lens{"fisheye", Distortion::equidistant, 300, {-0.01, 0.004, -0.002, 0.0004}}),
    [](const auto& lens) { return std::string(lens.param.name); });

StereoCalibration plain_pair() {
  StereoCalibration calibration;
  calibration.left = {64, 48, 50, 50, 31.5, 23.5, Distortion::none, {}};
  calibration.right = calibration.left;
  calibration.right_from_left.translation() = Vector3d(-0.1, 0, 0);
  calibration.origin = "plain.yaml";
  return calibration;
}

TEST(Rectifier, RefusesSwappedCamerasAndNamesTheFile) {
  StereoCalibration swapped = plain_pair();
  swapped.right_from_left = swapped.right_from_left.inverse();
  EXPECT_THAT([&] { Rectifier{swapped}; },
              ::testing::ThrowsMessage<std::runtime_error>(
                  ::testing::AllOf(::testing::HasSubstr("plain.yaml"), ::testing::HasSubstr("swapped"))));
}

TEST(Rectifier, RefusesAPairWithoutABaselineOrWithTwoResolutions) {
  StereoCalibration together = plain_pair();
  together.right_from_left.translation().setZero();
  EXPECT_THROW(Rectifier{together}, std::runtime_error);
  StereoCalibration unequal = plain_pair();
  unequal.right.width_px = 60;
  EXPECT_THROW(Rectifier{unequal}, std::runtime_error);
}

TEST(Rectifier, ARectifiedPairIsOnlyCutToOneCamera) {
  StereoCalibration shifted = plain_pair();
  shifted.right.cx_px -= 4;  // the right picture lies 4 pixels to the left
  shifted.rectified = true;
  Picture left{64, 48, 1, 8, std::vector<std::uint8_t>(64 * 48)}, right = left;
  for (int i = 0; i < 64 * 48; ++i) left.bytes[i] = right.bytes[i] = static_cast<std::uint8_t>(i % 64 * 3);
  const RectifiedFrame frame = Rectifier(shifted).rectify({1, left, right});
  EXPECT_EQ(frame.left.pixels, left.bytes);
  for (int x = 4; x < 64; ++x) EXPECT_EQ(frame.right.at(x, 10), left.bytes[10 * 64 + x - 4]);
}

TEST(Rectifier, ColourAndSixteenBitsBecomeGrey) {
  const Rectifier rectifier(plain_pair());
  const Picture colour{64, 48, 3, 8, std::vector<std::uint8_t>(64 * 48 * 3, 77)};
  Picture deep{64, 48, 1, 16, {}};
  for (int i = 0; i < 64 * 48; ++i) deep.bytes.insert(deep.bytes.end(), {0, 77});
  const RectifiedFrame frame = rectifier.rectify({1, colour, deep});
  EXPECT_THAT(frame.left.pixels, ::testing::Each(77));
  EXPECT_THAT(frame.right.pixels, ::testing::Each(77));
}

TEST(Rectifier, RefusesPicturesOfAnotherSize) {
  const Picture small{32, 48, 1, 8, std::vector<std::uint8_t>(32 * 48)};
  EXPECT_THROW(static_cast<void>(Rectifier(plain_pair()).rectify({1, small, small})), std::runtime_error);
}

}  // namespace
}  // namespace flogmap
