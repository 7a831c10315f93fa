#pragma once

#include <string>
#include <vector>

#include "camera/stereo_source.hpp"

namespace flogmap {

/// What a viewer must know of a source: frames that are missing, a camera that is gone, what was taken for
/// granted.
inline std::vector<std::string> source_warnings(const SkippedFrames& skipped, const std::string& assumed) {
  std::vector<std::string> warnings;
  if (skipped.count > 0) {
    warnings.push_back(std::to_string(skipped.count) + " frames skipped; last: " + skipped.last_reason);
  } else if (!skipped.last_reason.empty()) {
    warnings.push_back(skipped.last_reason);
  }
  if (!assumed.empty()) warnings.push_back(assumed);
  return warnings;
}

}  // namespace flogmap
