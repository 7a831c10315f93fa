#include "camera/source_spec.hpp"

#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "camera/calibration/calibration_checks.hpp"
#include "camera/calibration/detect.hpp"
#include "camera/euroc_source.hpp"
#include "camera/images_source.hpp"
#include "camera/kitti_source.hpp"
#include "camera/live/live_source.hpp"
#include "camera/mcap_source.hpp"
#include "camera/simulated_source.hpp"
#include "camera/simulation/scene_json.hpp"
#include "camera/video_source.hpp"

namespace flogmap {
namespace {

using Opener = std::unique_ptr<StereoSource> (*)(const SourceOptions& options, const std::string& where);

std::unique_ptr<StereoSource> open_pairs(const SourceOptions& options, PicturePairList list) {
  if (!options.calibration_file.empty()) list.calibration = read_calibration(options.calibration_file);
  if (list.calibration) check_baseline(*list.calibration);
  return std::make_unique<PicturePairSource>(options.spec, std::move(list), options.loop);
}

/// The calibration given; nothing if there is none and none is needed.
std::optional<StereoCalibration> given_calibration(const SourceOptions& options) {
  if (!options.calibration_file.empty()) return read_calibration(options.calibration_file);
  if (!options.needs_calibration) return std::nullopt;
  throw std::runtime_error("source '" + options.spec +
                           "' carries no calibration: give one with --calibration FILE");
}

bool needs_folders_calibration(const SourceOptions& options) {
  return options.calibration_file.empty() && options.needs_calibration;
}

std::unique_ptr<StereoSource> open_euroc(const SourceOptions& options, const std::string& where) {
  return open_pairs(options, list_euroc(where, needs_folders_calibration(options)));
}

std::unique_ptr<StereoSource> open_kitti(const SourceOptions& options, const std::string& where) {
  return open_pairs(options, list_kitti(where, needs_folders_calibration(options), options.frame_rate_hz));
}

std::unique_ptr<StereoSource> open_images(const SourceOptions& options, const std::string& where) {
  PicturePairList list = list_images(where, options.frame_rate_hz);
  (void)given_calibration(options);  // needed only where there are pictures
  return open_pairs(options, std::move(list));
}

std::unique_ptr<StereoSource> open_videos(const SourceOptions& options, const std::string& where) {
  std::optional<StereoCalibration> calibration = given_calibration(options);
  const std::size_t comma = where.find(',');
  if (comma == std::string::npos) throw std::runtime_error("video: must be LEFT,RIGHT, got '" + where + "'");
  return open_video({.spec = options.spec,
                     .left = where.substr(0, comma),
                     .right = where.substr(comma + 1),
                     .loop = options.loop,
                     .calibration = std::move(calibration)});
}

std::unique_ptr<StereoSource> open_side_by_side(const SourceOptions& options, const std::string& where) {
  std::optional<StereoCalibration> calibration = given_calibration(options);
  return open_video({.spec = options.spec,
                     .left = where,
                     .right = "",
                     .loop = options.loop,
                     .calibration = std::move(calibration)});
}

std::unique_ptr<StereoSource> open_recorded_topics(const SourceOptions& options, const std::string& where) {
  McapRecording recording{.spec = options.spec,
                          .where = where,
                          .loop = options.loop,
                          .max_skew_ms = options.max_skew_ms,
                          .reads_calibration = needs_folders_calibration(options)};
  if (!options.calibration_file.empty()) recording.calibration = read_calibration(options.calibration_file);
  std::unique_ptr<StereoSource> source = open_mcap(std::move(recording));
  if (const auto calibration = source->calibration()) check_baseline(*calibration);
  return source;
}

std::unique_ptr<StereoSource> open_cameras(const SourceOptions& options, const std::string& where) {
  LiveSpec live{.spec = options.spec, .where = where, .calibration = std::nullopt, .live = {}};
  if (!options.calibration_file.empty()) live.calibration = read_calibration(options.calibration_file);
  live.live = {.rate_hz = options.camera_rate_hz, .max_skew_ms = options.max_skew_ms};
  live.width_px = options.camera_width_px;
  live.height_px = options.camera_height_px;
  live.exposure_us = options.exposure_us;
  live.gain = options.gain;
  return open_live(std::move(live));
}

std::unique_ptr<StereoSource> open_simulated(const SourceOptions& options, const std::string& where) {
  return std::make_unique<SimulatedSource>(options.spec, load_scene(where), options.seed);
}

struct Kind {
  std::string_view name, where;
  Opener open;
};

constexpr std::array kKinds{
    Kind{"euroc", "DIR", open_euroc},
    Kind{"kitti", "DIR", open_kitti},
    Kind{"mcap", "FILE[,LEFT_TOPIC,RIGHT_TOPIC]", open_recorded_topics},
    Kind{"images", "LEFT_GLOB,RIGHT_GLOB", open_images},
    Kind{"video", "LEFT,RIGHT", open_videos},
    Kind{"sbs", "FILE", open_side_by_side},
    Kind{"sim", "SCENE", open_simulated},
    Kind{"libcamera", "LEFT_ID,RIGHT_ID", open_cameras},
};

}  // namespace

std::string source_kinds() {
  std::string text;
  for (const Kind& kind : kKinds) {
    text += (text.empty() ? "" : ", ") + std::string(kind.name) + ":" + std::string(kind.where);
  }
  return text;
}

std::unique_ptr<StereoSource> open_source(const SourceOptions& options) {
  const std::size_t colon = options.spec.find(':');
  const std::string name = options.spec.substr(0, colon);
  const std::string where = colon == std::string::npos ? "" : options.spec.substr(colon + 1);
  for (const Kind& kind : kKinds) {
    if (kind.name != name) continue;
    if (where.empty()) break;
    return kind.open(options, where);
  }
  throw std::runtime_error("source '" + options.spec + "' must be one of " + source_kinds());
}

}  // namespace flogmap
