// Square fiducial markers. The one place that knows OpenCV's aruco module, whose interface changed with 4.7.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "camera/image.hpp"

namespace flogmap {

/// A marker in a picture; corners clockwise from the upper left of the marker as printed.
struct Marker {
  int id = 0;
  std::array<Eigen::Vector2d, 4> corners_px;
};

/// Does this build have a detector? Without OpenCV's aruco module only chessboards can be found.
[[nodiscard]] bool markers_are_supported();

/// Names of the ArUco dictionaries that boards are printed with, commonest first: "4X4_50", ...
[[nodiscard]] const std::vector<std::string>& aruco_dictionaries();

/// Markers of one dictionary ("APRILTAG_36h11" or one of the above) with a black border of so many bits.
/// Throws std::runtime_error if this build has no detector or no such dictionary.
[[nodiscard]] std::vector<Marker> find_markers(const Image<std::uint8_t>& picture,
                                               const std::string& dictionary, int border_bits);

/// A marker as it is printed, for tests and boards: side_px x side_px, black on white without a margin.
[[nodiscard]] Image<std::uint8_t> draw_marker(const std::string& dictionary, int id, int border_bits,
                                              int side_px);

}  // namespace flogmap
