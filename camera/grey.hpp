#pragma once

#include "camera/image.hpp"

namespace flogmap {

/// Colour becomes grey, 16 bits become 8 (the upper ones).
[[nodiscard]] Image<std::uint8_t> to_grey(const Picture& picture);

}  // namespace flogmap
