#pragma once

#include "camera/image.hpp"

namespace flogmap {

/// Cameras of 10 or 12 bits are often stored in the lower bits of 16-bit pictures, which then look black. By
/// how many bits such a picture can be shifted up: 6 if none of its values reaches 1024, 4 if none reaches
/// 4096, else 0; 0 for 8 bits.
[[nodiscard]] int unused_bits(const Picture& picture);

/// Multiplies every value of a 16-bit picture by 2^bits; what exceeds 16 bits becomes 65535.
void shift_up(Picture& picture, int bits);

}  // namespace flogmap
