// A calibration finds the cameras that took the pictures; the verdict tells good ones from bad ones.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "camera/board_calibration/board_detector.hpp"
#include "camera/board_calibration/verdict.hpp"
#include "camera/calibration/opencv_calibration.hpp"
#include "camera/grey.hpp"
#include "camera/picture_files.hpp"
#include "tests/camera/rendered_board.hpp"

namespace flogmap {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using namespace flogmap::testing;

constexpr unsigned kSeed = 20261122;

/// A pair as a workshop builds it: not quite parallel, not quite equal.
StereoCalibration true_pair(Distortion model, std::vector<double> coefficients, double focal_px) {
  StereoCalibration pair;
  pair.left = {640, 480, focal_px, focal_px * 1.003, 324.4, 236.2, model, std::move(coefficients)};
  pair.right = pair.left;
  pair.right.fx_px *= 0.996;
  pair.right.fy_px *= 0.995;
  pair.right.cx_px = 313.1;
  pair.right.cy_px = 244.9;
  pair.right_from_left.linear() =
      Eigen::AngleAxisd(0.021, Eigen::Vector3d(0.3, -0.9, 0.2).normalized()).toRotationMatrix();
  pair.right_from_left.translation() << -0.1203, 0.0011, -0.0008;
  return pair;
}

struct Rig {
  BoardSpec spec;
  StereoCalibration truth;
  BoardPaint paint;
  double near = 1.4, reach = 0.3;
  bool y_is_up = false;
};

/// Renders, detects and calibrates; `count` pairs.
CalibrationResult calibrate(const Rig& rig, int count, std::vector<std::string>& names) {
  const BoardCamera left(rig.truth.left), right(rig.truth.right);
  BoardDetector detector(rig.spec);
  std::mt19937 random(kSeed);
  std::vector<BoardPair> pairs;
  for (const Eigen::Isometry3d& pose : board_poses(rig.spec, count, rig.near, rig.reach, rig.y_is_up)) {
    const Eigen::Isometry3d middle = Eigen::Translation3d(0.06, 0, 0) * pose;  // between both cameras
    BoardSighting in_left = detector.find(left.picture(rig.paint, middle, random));
    BoardSighting in_right =
        detector.find(right.picture(rig.paint, rig.truth.right_from_left * middle, random));
    if (rig.spec.pattern == BoardPattern::chessboard) {
      if (in_left.view.empty() || in_right.view.empty()) continue;
      match_directions(in_left.view, in_right.view);
    }
    pairs.push_back({in_left.view, in_right.view});
    names.push_back(std::to_string(pairs.size()));
  }
  return calibrate_stereo(board_points(rig.spec), pairs,
                          {.model = rig.truth.left.distortion, .width_px = 640, .height_px = 480});
}

/// The largest distance between the pixels where both cameras see a ray, over the picture's middle `share`.
double largest_difference_px(const CameraIntrinsics& truth, const CameraIntrinsics& found, double share) {
  double largest = 0;
  for (double y = -1; y <= 1; y += 0.1) {
    for (double x = -1; x <= 1; x += 0.1) {
      const Eigen::Vector2d pixel(truth.width_px * (0.5 + share * x / 2),
                                  truth.height_px * (0.5 + share * y / 2));
      const auto ray = ray_from_pixel(truth, pixel);
      if (ray) largest = std::max(largest, (pixel_from_ray(found, *ray) - pixel).norm());
    }
  }
  return largest;
}

/// Corners of small markers are found to about a tenth of a pixel, those of a chessboard better.
void expect_found(const Rig& rig, double focal_share, double baseline_m) {
  std::vector<std::string> names;
  const CalibrationResult result = calibrate(rig, 20, names);
  const CalibrationVerdict verdict = judge(result, names);
  EXPECT_GE(names.size(), 15U);
  EXPECT_LT(verdict.rms_px, 0.2);
  EXPECT_LT(verdict.epipolar_p95_px, rig.spec.pattern == BoardPattern::chessboard ? 0.25 : 0.35);
  EXPECT_NE(verdict.grade, CalibrationGrade::redo);
  EXPECT_NEAR(result.calibration.left.fx_px / rig.truth.left.fx_px, 1, focal_share);
  EXPECT_NEAR(result.calibration.right.fy_px / rig.truth.right.fy_px, 1, focal_share);
  EXPECT_NEAR(verdict.baseline_m, rig.truth.right_from_left.translation().norm(), baseline_m);
  const Eigen::AngleAxisd turn(result.calibration.right_from_left.linear().transpose() *
                               rig.truth.right_from_left.linear());
  EXPECT_LT(turn.angle(), 0.003);
}

TEST(BoardCalibration, FindsTheCamerasThatSawAChessboard) {
  const BoardSpec spec{.square_m = 0.06};  // 9x6
  expect_found(
      {spec, true_pair(Distortion::radtan, {-0.28, 0.09, 0.0004, -0.0003, 0}, 520), paint_chessboard(spec)},
      0.005, 0.0005);
}

TEST(BoardCalibration, FindsWideCamerasWithTheRationalModel) {
  const BoardSpec spec{.square_m = 0.06};
  const Rig rig{spec,
                true_pair(Distortion::rational, {0.35, 0.05, 0.0002, -0.0001, 0.002, 0.68, 0.16, 0.01}, 400),
                paint_chessboard(spec), 1.1, 0.45};
  std::vector<std::string> names;
  const CalibrationResult result = calibrate(rig, 20, names);
  EXPECT_LT(judge(result, names).epipolar_p95_px, 0.3);
  // Its coefficients trade off against one another; where rays fall does not.
  EXPECT_LT(largest_difference_px(rig.truth.left, result.calibration.left, 0.7), 1.0);
}

class MarkerBoards : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!markers_are_supported()) GTEST_SKIP() << "this OpenCV has no aruco module";
  }
};

TEST_F(MarkerBoards, AnAprilTagGridOfKalibrGivesTheCameras) {
  const BoardSpec spec{.pattern = BoardPattern::apriltag, .columns = 6, .rows = 5, .square_m = 0.07};
  expect_found({spec, true_pair(Distortion::radtan, {-0.28, 0.09, 0.0004, -0.0003, 0}, 520),
                paint_tags(spec, 2), 1.1, 0.3, true},
               0.005, 0.0008);
}

TEST_F(MarkerBoards, AFisheyePairIsFoundFromAnAprilTagGrid) {
  const BoardSpec spec{.pattern = BoardPattern::apriltag, .columns = 6, .rows = 5, .square_m = 0.08};
  expect_found({spec, true_pair(Distortion::equidistant, {0.05, -0.01, 0.003, -0.001}, 300),
                paint_tags(spec, 1), 0.6, 0.7, true},
               0.01, 0.001);
}

TEST_F(MarkerBoards, ACharucoBoardGivesTheCamerasAndItsDictionaryIsFoundOut) {
  const BoardSpec spec{.pattern = BoardPattern::charuco, .columns = 9, .rows = 7, .square_m = 0.06};
  expect_found({spec, true_pair(Distortion::radtan, {-0.28, 0.09, 0.0004, -0.0003, 0}, 520),
                paint_charuco(spec, "5X5_100", 5), 1.1, 0.3},
               0.005, 0.0008);
}

TEST_F(MarkerBoards, APictureThatShowsAnotherBoardIsRefusedInWords) {
  const BoardSpec printed{.pattern = BoardPattern::apriltag, .columns = 6, .rows = 5, .square_m = 0.07};
  BoardSpec asked = printed;
  asked.columns = 4;
  const StereoCalibration truth = true_pair(Distortion::radtan, {0, 0, 0, 0}, 520);
  std::mt19937 random(kSeed);
  BoardDetector detector(asked);
  const auto pose = board_poses(printed, 5, 1.2, 0.1, true)[0];
  const BoardSighting sighting =
      detector.find(BoardCamera(truth.left).picture(paint_tags(printed, 1), pose, random));
  EXPECT_TRUE(sighting.view.empty());
  EXPECT_THAT(sighting.problem, HasSubstr("--board"));
}

TEST(BoardCalibration, WhatItWritesTheReadersRead) {
  for (const Distortion model : {Distortion::radtan, Distortion::rational, Distortion::equidistant}) {
    std::vector<double> coefficients{0.1, -0.02, 0.001, -0.002};
    if (model == Distortion::rational) coefficients.insert(coefficients.end(), {0.01, 0.3, 0.05, 0.004});
    const StereoCalibration pair = true_pair(model, coefficients, 300);
    const StereoCalibration read = parse_opencv(format_opencv(pair), "written");
    EXPECT_EQ(read.left.distortion, model);
    EXPECT_EQ(read.left.coefficients, pair.left.coefficients);
    EXPECT_EQ(read.right.cx_px, pair.right.cx_px);
    EXPECT_TRUE(read.right_from_left.isApprox(pair.right_from_left, 1e-12));
  }
}

TEST(BoardCalibration, ImpossibleBoardsAreNamed) {
  EXPECT_THAT([] { check(BoardSpec{.columns = 1}); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("columns"), HasSubstr("allowed"))));
  EXPECT_THAT([] { check(BoardSpec{.square_m = 0}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("square")));
}

// ----------------------------------------------------------------------------------------------- verdict

/// A calibration's observations without pictures: exact corners of a few boards, with Gaussian noise.
CalibrationResult calibrate_points(double noise_px, double near, double reach, double tilt_share, int count) {
  const BoardSpec spec{.square_m = 0.06};
  const StereoCalibration truth = true_pair(Distortion::radtan, {-0.2, 0.05, 0, 0, 0}, 520);
  std::mt19937 random(kSeed);
  std::normal_distribution<double> noise(0, noise_px);
  std::vector<BoardPair> pairs;
  const std::vector<Eigen::Vector3d> board = board_points(spec);
  for (Eigen::Isometry3d pose : board_poses(spec, count, near, reach, false)) {
    const Eigen::AngleAxisd tilt(pose.linear());
    pose.linear() = Eigen::AngleAxisd(tilt.angle() * tilt_share, tilt.axis()).toRotationMatrix();
    BoardPair pair;
    for (int i = 0; i < std::ssize(board); ++i) {
      const Eigen::Vector3d p = pose * board[static_cast<std::size_t>(i)];
      const Eigen::Vector2d jitter(noise(random), noise(random)), other(noise(random), noise(random));
      pair.left.points.push_back(i);
      pair.left.pixels.emplace_back(pixel_from_ray(truth.left, p) + jitter);
      pair.right.points.push_back(i);
      pair.right.pixels.emplace_back(pixel_from_ray(truth.right, truth.right_from_left * p) + other);
    }
    pairs.push_back(std::move(pair));
  }
  return calibrate_stereo(board, pairs, {.model = Distortion::radtan, .width_px = 640, .height_px = 480});
}

std::vector<std::string> numbered(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("pair" + std::to_string(i));
  return names;
}

TEST(BoardCalibration, ExactCornersGiveTheExactCameras) {
  const CalibrationResult result = calibrate_points(0, 1.2, 0.4, 1, 12);
  const StereoCalibration truth = true_pair(Distortion::radtan, {-0.2, 0.05, 0, 0, 0}, 520);
  EXPECT_LT(result.rms_px, 1e-3);
  EXPECT_NEAR(result.calibration.left.fx_px, truth.left.fx_px, 0.02);
  EXPECT_NEAR(result.calibration.right.cy_px, truth.right.cy_px, 0.02);
  EXPECT_TRUE(result.calibration.right_from_left.isApprox(truth.right_from_left, 1e-4));
}

TEST(BoardCalibration, TheSpreadItReportsIsTheSpreadItHas) {
  const CalibrationResult result = calibrate_points(0.2, 1.2, 0.4, 1, 15);
  EXPECT_NEAR(result.rms_px, 0.2 * std::sqrt(2.0), 0.03);
  const double error = result.calibration.left.fx_px / 520 - 1;
  EXPECT_LT(std::abs(error), 4 * result.focal_sigma);
  EXPECT_GT(result.focal_sigma, 1e-5);
  EXPECT_LT(result.focal_sigma, 0.01);
}

TEST(CalibrationVerdict, NoisyCornersMeanRedo) {
  EXPECT_EQ(judge(calibrate_points(1.5, 1.2, 0.4, 1, 12), numbered(12)).grade, CalibrationGrade::redo);
}

TEST(CalibrationVerdict, BoardsThatAllFaceTheCameraAreToBeTilted) {
  EXPECT_THAT(judge(calibrate_points(0.1, 1.2, 0.4, 0.2, 12), numbered(12)).advice,
              Contains(HasSubstr("tilt it")));
}

TEST(CalibrationVerdict, AreasWithoutTheBoardAreNamed) {
  EXPECT_THAT(judge(calibrate_points(0.1, 2.5, 0.02, 1, 12), numbered(12)).advice,
              Contains(AllOf(HasSubstr("never saw"), HasSubstr("upper left"))));
}

TEST(CalibrationVerdict, APairOutOfStepIsNamed) {
  CalibrationResult result = calibrate_points(0.1, 1.2, 0.4, 1, 12);
  for (CornerError& corner : result.corners) {
    if (corner.pair == 7) corner.error_px += Eigen::Vector2d(3, 0);
  }
  EXPECT_THAT(judge(result, numbered(12)).advice, Contains(HasSubstr("pair7")));
}

TEST(BoardCalibration, TooFewPairsAreRefused) {
  EXPECT_THAT([] { (void)calibrate_stereo(board_points({}), {}, {.width_px = 640, .height_px = 480}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("pairs show the board")));
}

// --------------------------------------------------------------------------------------- real recordings

/// Calibrates a folder of left*/right* pictures of a 9x6 chessboard.
CalibrationVerdict calibrate_folder(const std::filesystem::path& folder) {
  const BoardSpec spec;
  BoardDetector detector(spec);
  std::vector<BoardPair> pairs;
  std::vector<std::string> names;
  int width = 0, height = 0;
  for (int i = 1; i < 20; ++i) {
    const std::string number = std::to_string(100 + i).substr(1);
    for (const char* extension : {".png", ".jpg"}) {
      const auto left = folder / ("left" + number + extension),
                 right = folder / ("right" + number + extension);
      if (!std::filesystem::exists(left)) continue;
      const Picture picture = read_picture(left).picture;
      width = picture.width, height = picture.height;
      BoardSighting in_left = detector.find(to_grey(picture));
      BoardSighting in_right = detector.find(to_grey(read_picture(right).picture));
      if (in_left.view.empty() || in_right.view.empty()) continue;
      match_directions(in_left.view, in_right.view);
      pairs.push_back({in_left.view, in_right.view});
      names.push_back(left.filename().string());
    }
  }
  return judge(calibrate_stereo(board_points(spec), pairs, {.width_px = width, .height_px = height}), names);
}

TEST(RealBoards, Case1MeetsItsBar) {
  const char* data = std::getenv("FLOGMAP_DATA");
  if (data == nullptr) GTEST_SKIP() << "FLOGMAP_DATA is not set";
  const CalibrationVerdict verdict =
      calibrate_folder(std::filesystem::path(data) / "calibration_chessboard" / "case1");
  EXPECT_LE(verdict.rms_px, 0.25);
  EXPECT_LE(verdict.epipolar_p95_px, 0.4);
  EXPECT_EQ(verdict.num_pairs, 13U);
}

}  // namespace
}  // namespace flogmap
