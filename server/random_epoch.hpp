#pragma once

#include <string>

namespace flogmap {

/// A name for a map that no other has: 16 hex digits.
std::string random_epoch();

}  // namespace flogmap
