#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace flogmap {

/// Where on a face a pattern is asked for, in metres from the face's lower left corner.
struct PatternPoint {
  double u = 0, v = 0;
  double width = 1, height = 1;  // of the face
  double size = 0.2;             // of the pattern's unit
  std::uint32_t seed = 0;        // differs from face to face
};

/// The tone of a surface at a point: 0 darkest to 1 brightest.
using Pattern = double (*)(const PatternPoint&);

/// Throws std::runtime_error naming the patterns there are.
[[nodiscard]] Pattern find_pattern(const std::string& name);

}  // namespace flogmap
