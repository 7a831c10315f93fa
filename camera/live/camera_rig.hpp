// Two live cameras as values and commands. libcamera stands behind it, or a fake in tests.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/frame_pairing.hpp"

namespace flogmap {

struct RigOptions {
  std::string left_id, right_id;  // as `flogmap cameras` lists them
  int width_px = 640;
  int height_px = 480;
  double rate_hz = 20;
  double exposure_us = 0;  // 0: the left camera's automatic exposure, which the right one follows
  double gain = 0;         // 0: automatic, likewise
};

/// A picture of one camera, grey, with what it was exposed with (0 if the camera does not say).
struct RigPicture {
  Side side = Side::left;
  TimedPicture picture;
  double exposure_us = 0;
  double gain = 0;
};

class CameraRig {
 public:
  virtual ~CameraRig() = default;

  /// The next picture of either camera; nothing after this time, after stop(), or when a camera is lost.
  virtual std::optional<RigPicture> wait(std::chrono::milliseconds longest) = 0;
  /// Why there are no more pictures: "camera X was unplugged"; empty while both run.
  [[nodiscard]] virtual std::string lost() const = 0;
  /// Opens both cameras again after one was lost; false if they are not there yet.
  virtual bool reopen() = 0;
  /// From any thread: ends a wait().
  virtual void stop() = 0;

  /// The cameras keep step by themselves (hardware or rpi sync); then set_right_duration() is not needed.
  [[nodiscard]] virtual bool keeps_step() const = 0;
  virtual void set_right_duration(std::int64_t duration_ns) = 0;
  /// The right camera is exposed as the left one was.
  virtual void set_right_exposure(double exposure_us, double gain) = 0;
};

struct CameraDescription {
  std::string id, model;
  std::vector<std::string> formats;  // "NV12 640x480 ... 1920x1080"
};

/// Throws std::runtime_error naming the camera and what there is, or that this build has no libcamera.
[[nodiscard]] std::unique_ptr<CameraRig> open_libcamera_rig(const RigOptions& options);

/// All cameras that libcamera sees; throws if this build has none.
[[nodiscard]] std::vector<CameraDescription> list_cameras();

}  // namespace flogmap
