#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "camera/stereo_source.hpp"

namespace flogmap {

/// How a user names a source: `spec` is "kind:where", for instance "euroc:/data" or "sim:room".
struct SourceOptions {
  std::string spec{};
  std::string calibration_file{};  // overrides what the source carries; empty: the source's own
  bool needs_calibration = true;   // false: whoever opens it can do without, as one who calibrates
  bool loop = false;          // a recording begins again at its end; the drop of its timestamp tells the wrap
  std::uint64_t seed = 1;     // of everything random in a simulated source
  double frame_rate_hz = 10;  // of picture files whose times nothing says
  // live cameras
  int camera_width_px = 0, camera_height_px = 0;  // where no calibration says; 0: 640x480
  double camera_rate_hz = 20;
  double max_skew_ms = 5;  // pairs taken further apart are dropped; of recorded topics, too
  double exposure_us = 0;  // 0: automatic; both cameras alike
  double gain = 0;         // 0: automatic
};

/// The kinds of sources this build knows, as "euroc, kitti, ...", for messages and help.
[[nodiscard]] std::string source_kinds();

/// Opens a source. Throws std::runtime_error with one line that names the spec and what is allowed.
[[nodiscard]] std::unique_ptr<StereoSource> open_source(const SourceOptions& options);

}  // namespace flogmap
