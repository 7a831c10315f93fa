// How far every cell is from the nearest obstacle.
#pragma once

#include <cstdint>

#include "camera/image.hpp"

namespace flogmap {

/// Distance from the middle of every pixel to the middle of the nearest one where `blocked` is not 0, in
/// pixels; 0 there, infinite if there is none. Exact, in time linear in the number of pixels, after P.
/// Felzenszwalb and D. Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 8
/// (2012).
Image<float> distance_to_blocked(const Image<std::uint8_t>& blocked);

}  // namespace flogmap
