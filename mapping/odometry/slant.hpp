// How the disparity of a small surface changes across the picture.
#pragma once

#include <Eigen/Core>

#include "mapping/view.hpp"

namespace flogmap {

/// (dd/dx, dd/dy) of the left picture, px per px: zero for a surface that faces the cameras, 0.3 and more on
/// a floor. A patch that is taken to face them is found where its texture is, and that with the wrong
/// disparity.
using Slant = Eigen::Vector2d;

/// The plane through the dense disparities around a corner that belong to the surface of disparity
/// `disparity_px`; zero where they are too few or do not lie in a plane.
[[nodiscard]] Slant slant_at(const DisparityImage& disparity, const Eigen::Vector2f& px, float disparity_px);

/// Turns offsets in the right picture into those in the left one: x_r = x - d(x, y).
[[nodiscard]] Eigen::Matrix2d left_from_right(const Slant& slant);

}  // namespace flogmap
