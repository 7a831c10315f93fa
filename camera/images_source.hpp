#pragma once

#include <string>

#include "camera/picture_pair_source.hpp"

namespace flogmap {

/// Lists "LEFT_GLOB,RIGHT_GLOB". Pictures are paired by the last number in their names if every name has one
/// of its own, otherwise by order. Numbers of 16 digits and more are times in nanoseconds; else the pictures
/// are taken to come at `rate_hz`, and the list says so. Throws std::runtime_error naming a glob that matches
/// nothing.
[[nodiscard]] PicturePairList list_images(const std::string& globs, double rate_hz = 10);

}  // namespace flogmap
