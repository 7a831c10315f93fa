// Every dialect says the same pair, every mistake is named, no input crashes a reader.
#include <gmock/gmock.h>

#include <random>
#include <stdexcept>

#include "camera/calibration/detect.hpp"
#include "camera/calibration/opencv_calibration.hpp"
#include "tests/camera/temporary_folder.hpp"

namespace flogmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kEurocLeft = R"(%YAML:1.0
---
# a comment
sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [0.0, 0.0, 1.0, 0.05, -1.0, 0.0, 0.0, 0.02, 0.0, -1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 1.0]
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.5, 457.25, 367.5, 248.375]
distortion_model: radial-tangential
distortion_coefficients: [-0.28, 0.07, 0.0002, 0.00002]
)";
// The right camera 0.11 m to the right of the left one, in the body's frame along -y.
constexpr const char* kEurocRight = R"(sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [0.0, 0.0, 1.0, 0.05,
        -1.0, 0.0, 0.0, -0.09,
         0.0, -1.0, 0.0, 0.1,
         0.0, 0.0, 0.0, 1.0]
resolution: [752, 480]
camera_model: pinhole
intrinsics: [457.5, 456.125, 380.0, 255.25] #fu, fv, cu, cv
distortion_model: radial-tangential
distortion_coefficients: [-0.27, 0.06, -0.0001, -0.00003]
)";

constexpr const char* kKalibr = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 0.00002]
  distortion_model: radtan
  intrinsics: [458.5, 457.25, 367.5, 248.375]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.11]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: [-0.27, 0.06, -0.0001, -0.00003]
  distortion_model: radtan
  intrinsics: [457.5, 456.125, 380.0, 255.25]
  resolution: [752, 480]
)";

constexpr const char* kOpencv = R"(%YAML:1.0
---
image_width: 752
image_height: 480
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 458.5, 0., 367.5, 0., 457.25, 248.375, 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 14
   dt: d
   data: [ -0.28, 0.07, 0.0002, 2.0e-05, 0., 0., 0., 0., 0., 0., 0., 0., 0., 0. ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 457.5, 0., 380., 0., 456.125, 255.25, 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.27, 0.06, -0.0001, -3.0e-05, 0. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -0.11, 0., 0. ]
)";

constexpr const char* kOpencvXml = R"(<?xml version="1.0"?>
<opencv_storage>
<!-- made by hand -->
<size>752 480</size>
<cameraMatrix1 type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt>
  <data>458.5 0. 367.5 0. 457.25 248.375 0. 0. 1.</data></cameraMatrix1>
<distCoeffs1 type_id="opencv-matrix"><rows>1</rows><cols>4</cols><dt>d</dt><data>-0.28 0.07 0.0002 0.00002</data></distCoeffs1>
<cameraMatrix2 type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt>
  <data>457.5 0. 380. 0. 456.125 255.25 0. 0. 1.</data></cameraMatrix2>
<distCoeffs2 type_id="opencv-matrix"><rows>1</rows><cols>4</cols><dt>d</dt><data>-0.27 0.06 -0.0001 -0.00003</data></distCoeffs2>
<R type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt><data>1 0 0 0 1 0 0 0 1</data></R>
<T type_id="opencv-matrix"><rows>3</rows><cols>1</cols><dt>d</dt><data>-0.11 0 0</data></T>
</opencv_storage>
)";

constexpr const char* kRosLeft = R"(image_width: 752
image_height: 480
camera_name: left
camera_matrix: {rows: 3, cols: 3, data: [458.5, 0, 367.5, 0, 457.25, 248.375, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 4, data: [-0.28, 0.07, 0.0002, 0.00002]}
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [435, 0, 370, 0, 0, 435, 250, 0, 0, 0, 1, 0]}
)";
constexpr const char* kRosRight = R"(image_width: 752
image_height: 480
camera_name: right
camera_matrix: {rows: 3, cols: 3, data: [457.5, 0, 380, 0, 456.125, 255.25, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 4, data: [-0.27, 0.06, -0.0001, -0.00003]}
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [435, 0, 370, -47.85, 0, 435, 250, 0, 0, 0, 1, 0]}
)";

void expect_the_pair(const StereoCalibration& c, const std::string& dialect) {
  EXPECT_EQ(c.dialect, dialect);
  EXPECT_EQ(c.left.width_px, 752);
  EXPECT_EQ(c.right.height_px, 480);
  EXPECT_EQ(c.left.fx_px, 458.5);
  EXPECT_EQ(c.left.fy_px, 457.25);
  EXPECT_EQ(c.right.cx_px, 380.0);
  EXPECT_EQ(c.right.cy_px, 255.25);
  EXPECT_EQ(c.left.distortion, Distortion::radtan);
  ASSERT_GE(c.left.coefficients.size(), 4U);
  EXPECT_EQ(c.left.coefficients[0], -0.28);
  EXPECT_EQ(c.right.coefficients[3], -0.00003);
  EXPECT_TRUE(c.right_from_left.linear().isIdentity(1e-12));
  EXPECT_TRUE(c.right_from_left.translation().isApprox(Eigen::Vector3d(-0.11, 0, 0), 1e-9));
}

class Dialects : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
  StereoCalibration read(const std::string& text) {
    return read_calibration(folder_.write("c.txt", text).string());
  }
  StereoCalibration read_two(const std::string& left, const std::string& right) {
    return read_calibration(folder_.write("a", left).string() + "," + folder_.write("b", right).string());
  }
};

TEST_F(Dialects, AllFiveSayTheSamePair) {
  folder_.write("rec/mav0/cam0/sensor.yaml", kEurocLeft);
  folder_.write("rec/mav0/cam1/sensor.yaml", kEurocRight);
  expect_the_pair(read_calibration((folder_.path() / "rec").string()), "euroc");
  expect_the_pair(read_two(kEurocLeft, kEurocRight), "euroc");
  expect_the_pair(read(kKalibr), "kalibr");
  expect_the_pair(read(kOpencv), "opencv");
  expect_the_pair(read(kOpencvXml), "opencv");
  expect_the_pair(read_two(kRosLeft, kRosRight), "ros");
}

TEST_F(Dialects, KittiIsRectifiedAndHasItsBaseline) {
  const StereoCalibration c =
      read("P0: 7.0e+02 0 600 0 0 7.0e+02 170 0 0 0 1 0\nP1: 700 0 600 -350 0 700 170 0 0 0 1 0\n");
  EXPECT_EQ(c.dialect, "kitti");
  EXPECT_TRUE(c.rectified);
  EXPECT_EQ(c.left.fx_px, 700);
  EXPECT_NEAR(c.right_from_left.translation().x(), -0.5, 1e-12);
}

TEST_F(Dialects, RosRectificationTurnsTheRightCamera) {
  // Rectified axes turned by 0.1 rad about y against the right camera's own.
  std::string right = kRosRight;
  const std::string identity = "data: [1, 0, 0, 0, 1, 0, 0, 0, 1]";
  right.replace(right.find(identity), identity.size(),
                "data: [0.99500416527802576, 0, 0.099833416646828152, 0, 1, 0, -0.099833416646828152, 0, "
                "0.99500416527802576]");
  const StereoCalibration c = read_two(kRosLeft, right);
  const Eigen::AngleAxisd turn(c.right_from_left.linear());
  EXPECT_NEAR(turn.angle(), 0.1, 1e-9);
  EXPECT_NEAR(c.right_from_left.inverse().translation().x(), 0.11, 1e-9);  // where the right camera stands
}

TEST_F(Dialects, WhatWeWriteWeRead) {
  StereoCalibration out = read(kKalibr);
  out.right_from_left.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()));
  for (const auto& [model, coefficients] :
       {std::pair(Distortion::radtan, std::vector{0.1, -0.2, 0.001, 0.002, 0.03}),
        std::pair(Distortion::rational, std::vector{0.1, -0.2, 0.001, 0.002, 0.03, 0.4, 0.5, 0.6}),
        std::pair(Distortion::equidistant, std::vector{0.1, -0.2, 0.001, 0.002})}) {
    out.left.distortion = out.right.distortion = model;
    out.left.coefficients = out.right.coefficients = coefficients;
    const StereoCalibration in = read(format_opencv(out));
    EXPECT_EQ(in.left.distortion, model);
    EXPECT_EQ(in.right.coefficients, coefficients);
    EXPECT_EQ(in.left.fx_px, out.left.fx_px);
    EXPECT_TRUE(in.right_from_left.isApprox(out.right_from_left, 1e-12));
  }
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST_F(Dialects, MistakesAreNamedWithFileFieldAndValue) {
  const auto fails = [&](const std::string& text, const std::string& field, const std::string& value) {
    EXPECT_THAT(
        [&] { static_cast<void>(read(text)); },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("c.txt"), HasSubstr(field), HasSubstr(value))));
  };
  fails(replaced(kKalibr, "[752, 480]", "[752, x]"), "cam0.resolution", "'x'");
  fails(replaced(kKalibr, "[752, 480]", "[-3, 480]"), "cam0.resolution", "-3");
  fails(replaced(kKalibr, "pinhole", "omni"), "cam0.camera_model", "omni");
  fails(replaced(kKalibr, "radtan", "spline"), "distortion", "spline");
  fails(replaced(kKalibr, "458.5", ".nan"), "cam0.intrinsics", "finite");
  fails(replaced(kKalibr, "458.5", "-458.5"), "cam0.intrinsics", "-458.5");
  fails(replaced(kKalibr, "T_cn_cnm1", "T_other"), "cam1.T_cn_cnm1", "missing");
  fails(replaced(kKalibr, "-0.11]", "-110]"), "millimetres", "110");
  fails(replaced(kOpencv, "D1:", "D9:"), "D1", "missing");
  fails(replaced(kOpencv, "data: [ 1., 0., 0.,", "data: [ 2., 0., 0.,"), "R", "rotation");
  fails("P0: 1 0 0 0 0 1 0 0 0 0 1\n", "P0", "12");
  fails("hello: world\n", "not a stereo calibration", "Kalibr");
  fails(": : :\n- x", "YAML", "c.txt");
  fails("<opencv_storage><M1><data>1 2", "M1", "closed");
  EXPECT_THAT(
      [&] { static_cast<void>(read_two(replaced(kEurocLeft, "1.0, 0.05", "1.5, 0.05"), kEurocRight)); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("T_BS"), HasSubstr("rotation"))));
  EXPECT_THROW(static_cast<void>(read_calibration("/nowhere/calib.yaml")), std::runtime_error);
}

TEST_F(Dialects, DamagedTextNeverCrashes) {
  std::mt19937 random(17);
  for (const std::string original : {kKalibr, kOpencv, kOpencvXml, kRosLeft, kEurocLeft}) {
    for (int trial = 0; trial < 60; ++trial) {
      std::string text = original;
      for (int edit = 0; edit < 4; ++edit) {
        const std::size_t at = random() % text.size();
        if (random() % 2) {
          text[at] = static_cast<char>(random() % 256);
        } else {
          text.erase(at, random() % 40);
        }
        if (text.empty()) break;
      }
      try {
        static_cast<void>(trial % 2 ? read(text) : read_two(text, original));
      } catch (const std::runtime_error& error) {
        EXPECT_STRNE(error.what(), "");
      }
    }
  }
}

}  // namespace
}  // namespace flogmap
