#include "camera/board_calibration/board.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace flogmap {
namespace {

std::vector<Eigen::Vector3d> lattice(int columns, int rows, double pitch_m) {
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      points.emplace_back(column * pitch_m, row * pitch_m, 0.0);
  }
  return points;
}

/// Four corners of each tag, the tags row by row from the lower left (as Kalibr numbers them), the corners
/// from the upper left clockwise; y points up the board.
std::vector<Eigen::Vector3d> tag_corners(const BoardSpec& spec) {
  const double side = spec.square_m;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& at : lattice(spec.columns, spec.rows, side * (1 + spec.tag_gap_share))) {
    for (const auto& [x, y] :
         {std::pair(0.0, side), std::pair(side, side), std::pair(side, 0.0), std::pair(0.0, 0.0)})
      points.emplace_back(at.x() + x, at.y() + y, 0.0);
  }
  return points;
}

void require(bool good, const std::string& field, double value, const std::string& allowed) {
  if (good) return;
  throw std::runtime_error(field + " is " + std::to_string(value) + ", allowed: " + allowed);
}

}  // namespace

std::vector<Eigen::Vector3d> board_points(const BoardSpec& spec) {
  switch (spec.pattern) {
    case BoardPattern::chessboard:
      return lattice(spec.columns, spec.rows, spec.square_m);
    case BoardPattern::charuco:
      return lattice(spec.columns - 1, spec.rows - 1, spec.square_m);
    case BoardPattern::apriltag:
      return tag_corners(spec);
  }
  return {};
}

void check(const BoardSpec& spec) {
  constexpr int kMost = 100;
  const int least = spec.pattern == BoardPattern::apriltag ? 2 : 3;
  const std::string counts = std::to_string(least) + " to " + std::to_string(kMost);
  if (std::min(spec.columns, spec.rows) < least || std::max(spec.columns, spec.rows) > kMost) {
    throw std::runtime_error("board: " + std::to_string(spec.columns) + "x" + std::to_string(spec.rows) +
                             ": allowed are " + counts + " columns and rows");
  }
  require(spec.square_m >= 1e-4 && spec.square_m <= 10, "side of a square in metres", spec.square_m,
          "0.0001 to 10");
  require(spec.marker_share > 0.1 && spec.marker_share < 1, "marker / square", spec.marker_share, "0.1 to 1");
  require(spec.tag_gap_share > 0 && spec.tag_gap_share <= 2, "gap / tag", spec.tag_gap_share, "above 0 to 2");
}

}  // namespace flogmap
