// Pixels as PNG files.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "camera/image.hpp"

namespace flogmap {

using Rgb = std::array<std::uint8_t, 3>;
using GreyAlpha = std::array<std::uint8_t, 2>;  // alpha 0: nothing known

/// The bytes of a PNG file, lossless.
std::string png_of(const Image<std::uint8_t>& grey);
std::string png_of(const Image<Rgb>& colour);
std::string png_of(const Image<GreyAlpha>& grey);

}  // namespace flogmap
