// Calibration boards: what is printed on them, and what a picture shows of them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "camera/image.hpp"

namespace flogmap {

enum class BoardPattern : std::uint8_t { chessboard, charuco, apriltag };

/// A flat board. Columns and rows count inner corners of a chessboard, squares of a ChArUco board, tags of an
/// AprilTag grid.
struct BoardSpec {
  BoardPattern pattern = BoardPattern::chessboard;
  int columns = 9;
  int rows = 6;
  double square_m = 0.025;     // side of a square; of a tag without its white border for a grid of tags
  double marker_share = 0.75;  // ChArUco: side of a marker / side of a square
  double tag_gap_share = 0.3;  // AprilTag grid: gap between tags / side of a tag (Kalibr's tagSpacing)
  std::string dictionary{};    // ChArUco: "4X4_50", ...; empty: found out from the pictures
};

/// Where every point of the board lies on it, metres; z = 0. The index is the point's number.
[[nodiscard]] std::vector<Eigen::Vector3d> board_points(const BoardSpec& spec);

/// The points that one picture shows.
struct BoardView {
  std::vector<int> points;              // numbers of board_points()
  std::vector<Eigen::Vector2d> pixels;  // where they are in the picture
  [[nodiscard]] bool empty() const { return points.empty(); }
};

/// What was found in one picture, or why nothing was.
struct BoardSighting {
  BoardView view;
  std::string problem;  // in words; empty if there is a view
};

/// Throws std::runtime_error naming field, value and what is allowed.
void check(const BoardSpec& spec);

}  // namespace flogmap
