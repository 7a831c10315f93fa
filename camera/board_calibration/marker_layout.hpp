#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "camera/board_calibration/board.hpp"
#include "camera/board_calibration/markers.hpp"

namespace flogmap {

/// Where the markers of a board lie on it: one way of printing it.
struct MarkerLayout {
  std::vector<std::array<Eigen::Vector2d, 4>>
      corners_m;  // by marker number, in the order of Marker::corners_px
};

/// All ways in which such boards are printed: ChArUco boards begin with a black square, or, where the
/// number of rows is even and OpenCV older than 4.6 made them, with a white one; the tags of a grid count
/// upwards (Kalibr) or downwards and stand in any of four directions.
[[nodiscard]] std::vector<MarkerLayout> possible_layouts(const BoardSpec& spec);

/// How far the markers seen lie from the layout [sides of a marker]: root mean square through the best
/// plane-to-plane map of each marker and its neighbours, the upper quartile over the
/// markers. All ids are the board's.
[[nodiscard]] std::optional<double> misfit(const MarkerLayout& layout, const std::vector<Marker>& markers);

}  // namespace flogmap
