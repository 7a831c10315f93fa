#pragma once

#include <memory>
#include <optional>
#include <string>

#include "camera/calibration/stereo_calibration.hpp"
#include "camera/stereo_source.hpp"
#include "mapping/flog/map_integrator.hpp"
#include "mapping/front_end.hpp"
#include "mapping/loop/loop_closer.hpp"
#include "server/options.hpp"

namespace flogmap {

/// The parts of a pipeline, opened and checked.
struct MappingSession {
  std::unique_ptr<StereoSource> source;
  StereoCalibration calibration;
  FrontEnd front_end;
  MapIntegrator integrator;
};

/// Keeps --map-memory, before the first tile is made: the rest lies beside the store or the output, or else
/// where temporary files that outlive memory go. Throws UsageError if no file can be made there.
void limit_map_memory(const Options& options);

/// Opens source and calibration, reads given poses, and makes front end and map.
/// Throws UsageError naming file, field and value if any of them cannot be used.
MappingSession open_session(const Options& options);

/// How loops are closed; nothing if they are not to be, or if the poses are given.
std::optional<LoopOptions> loop_options(const Options& options);

/// The calibration as one normalised document, for GET /calibration and the stored map.
std::string calibration_json(const StereoCalibration& calibration, const StereoCamera& rectified);

}  // namespace flogmap
