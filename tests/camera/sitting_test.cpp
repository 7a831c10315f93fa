// A board before two cameras, held here and there: what is kept, what is asked for, what comes out.
#include "camera/board_calibration/sitting.hpp"

#include <gmock/gmock.h>

#include "camera/board_calibration/verdict.hpp"
#include "tests/camera/rendered_board.hpp"

namespace flogmap {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 320, kHeight = 240;

const BoardSpec kBoard{.square_m = 0.06};  // 9x6

CameraIntrinsics camera() {
  CameraIntrinsics camera;
  camera.width_px = kWidth;
  camera.height_px = kHeight;
  camera.fx_px = camera.fy_px = 260;
  camera.cx_px = 159.5;
  camera.cy_px = 119.5;
  camera.distortion = Distortion::radtan;
  camera.coefficients = {0, 0, 0, 0};
  return camera;
}

/// Where a pinhole camera at `camera_from_board` sees every point of the board.
BoardView view_of(const Eigen::Isometry3d& camera_from_board) {
  BoardView view;
  for (const Eigen::Vector3d& point : board_points(kBoard)) {
    view.points.push_back(static_cast<int>(view.points.size()));
    view.pixels.push_back(pixel_from_ray(camera(), camera_from_board * point));
  }
  return view;
}

Eigen::Isometry3d facing(double turn_rad, const Eigen::Vector3d& axis) {
  const std::vector<Eigen::Vector3d> points = board_points(kBoard);
  Eigen::Isometry3d pose(Eigen::Translation3d(0.05, 0.02, 0.8));
  pose.rotate(Eigen::AngleAxisd(turn_rad, axis));
  pose.translate(-(points.front() + points.back()) / 2);
  return pose;
}

TEST(NearerSide, IsToldByPerspectiveAndByHowMuch) {
  const std::vector<Eigen::Vector3d> board = board_points(kBoard);
  const double half_m = (board.back().x() - board.front().x()) / 2;
  for (const double turn : {-0.5, -0.2, 0.2, 0.5}) {
    // About y, which points down, a positive turn brings the right side nearer; about x, the upper side.
    const Eigen::Vector2d nearer = nearer_side(view_of(facing(turn, Eigen::Vector3d::UnitY())), board);
    EXPECT_NEAR(nearer.x(), half_m * std::sin(turn) / 0.8, 0.005) << turn;
    EXPECT_NEAR(nearer.y(), 0, 0.02);
    const Eigen::Vector2d leaned = nearer_side(view_of(facing(turn, Eigen::Vector3d::UnitX())), board);
    EXPECT_EQ(leaned.y() < 0, turn > 0);
  }
  EXPECT_LT(nearer_side(view_of(facing(0, Eigen::Vector3d::UnitX())), board).norm(), 1e-9);
  EXPECT_TRUE(nearer_side({}, board).isZero());
}

/// A pair of cameras 6 cm apart that look at a rendered board.
class Cameras {
 public:
  void show(CalibrationSitting& sitting, const Eigen::Isometry3d& left_from_board, int times = 2) {
    Eigen::Isometry3d right_from_board = Eigen::Translation3d(-0.06, 0, 0) * left_from_board;
    const auto left = camera_.picture(paint_, left_from_board, random_);
    const auto right = camera_.picture(paint_, right_from_board, random_);
    for (int i = 0; i < times; ++i) sitting.look_at(left, right);
  }

 private:
  testing::BoardCamera camera_{camera()};
  testing::BoardPaint paint_ = testing::paint_chessboard(kBoard);
  std::mt19937 random_{7};
};

TEST(CalibrationSitting, KeepsABoardAtRestOnceAndNoneThatMoves) {
  Cameras cameras;
  CalibrationSitting sitting(kBoard);
  EXPECT_EQ(sitting.state().num_pairs, 0U);
  Eigen::Isometry3d pose = Eigen::Translation3d(0, 0, 0.8) * facing(0.1, Eigen::Vector3d::UnitY());
  cameras.show(sitting, pose, 1);
  EXPECT_EQ(sitting.state().num_pairs, 0U);  // nothing tells yet whether it moves
  EXPECT_EQ(sitting.state().advice, "Hold it still");
  cameras.show(sitting, pose, 3);
  EXPECT_EQ(sitting.state().num_pairs, 1U);
  EXPECT_THAT(sitting.state().advice, HasSubstr("Hold the board to the upper left of the left picture"));
  pose.pretranslate(Eigen::Vector3d(0.15, 0, 0));
  cameras.show(sitting, pose, 1);
  EXPECT_EQ(sitting.state().num_pairs, 1U);
  cameras.show(sitting, pose, 1);
  EXPECT_EQ(sitting.state().num_pairs, 2U);  // the same place with other noise
  cameras.show(sitting, pose, 1);
  EXPECT_EQ(sitting.state().num_pairs, 2U);
  sitting.restart();
  EXPECT_EQ(sitting.state().num_pairs, 0U);
}

TEST(CalibrationSitting, SaysWhichCameraDoesNotSeeTheBoard) {
  CalibrationSitting sitting(kBoard);
  const Image<std::uint8_t> empty(kWidth, kHeight);
  sitting.look_at(empty, empty);
  EXPECT_THAT(sitting.state().advice, HasSubstr("Show the whole board to both cameras"));
  std::mt19937 random(1);
  const auto seen = testing::BoardCamera(camera()).picture(testing::paint_chessboard(kBoard),
                                                           facing(0, Eigen::Vector3d::UnitX()), random);
  sitting.look_at(seen, empty);
  EXPECT_THAT(sitting.state().advice, HasSubstr("The right camera"));
  sitting.look_at(empty, seen);
  EXPECT_THAT(sitting.state().advice, HasSubstr("The left camera"));
}

TEST(CalibrationSitting, ABoardHeldAllOverThePictureEndsInACalibration) {
  Cameras cameras;
  CalibrationSitting sitting(kBoard);
  int shown = 0;
  for (const Eigen::Isometry3d& pose : testing::board_poses(kBoard, 40, 1.3, 0.55, false)) {
    cameras.show(sitting, pose);
    ++shown;
    if (sitting.state().enough) break;
  }
  EXPECT_TRUE(sitting.state().enough) << sitting.state().advice << " after " << shown;
  EXPECT_GE(sitting.pairs().size(), CalibrationSitting::kEnoughPairs);
  const CalibrationResult result =
      calibrate_stereo(board_points(kBoard), sitting.pairs(), {.width_px = kWidth, .height_px = kHeight});
  const CalibrationVerdict verdict = judge(result, sitting.names());
  EXPECT_NE(verdict.grade, CalibrationGrade::redo);
  EXPECT_NEAR(verdict.baseline_m, 0.06, 0.001);
  EXPECT_NEAR(result.calibration.left.fx_px, 260, 3);
}

}  // namespace
}  // namespace flogmap
