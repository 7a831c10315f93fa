#include "camera/live/libcamera_camera.hpp"

#include <libcamera/libcamera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "camera/live/luma.hpp"
#include "camera/live/picture_buffers.hpp"

namespace flogmap {
namespace {

namespace lc = libcamera;

constexpr unsigned kBuffers = 4;

std::int64_t period_of(double rate_hz) { return std::llround(1e9 / rate_hz); }

/// Raspberry Pi's controls exist by name only where its own fork of libcamera is installed.
std::optional<unsigned> control_named(const lc::ControlInfoMap& controls, const std::string& name) {
  for (const auto& [id, info] : controls) {
    if (id->name() == name) return id->id();
  }
  return std::nullopt;
}

/// The formats that we read, best first: grey, then luma planes, then mosaics.
std::optional<lc::PixelFormat> best_format(const lc::StreamFormats& formats) {
  for (const char* name : {"NV12", "YUV420", "NV21", "R8", "YUYV", "R10_CSI2P", "SRGGB8", "SGRBG8", "SGBRG8",
                           "SBGGR8", "SRGGB10_CSI2P", "SGRBG10_CSI2P", "SGBRG10_CSI2P", "SBGGR10_CSI2P"}) {
    for (const lc::PixelFormat& format : formats.pixelformats()) {
      if (format.toString() == name) return format;
    }
  }
  return std::nullopt;
}

}  // namespace

class LibcameraCamera::Impl {
 public:
  Impl(std::shared_ptr<libcamera::Camera> camera, Side side, const RigOptions& options, OnPicture on_picture,
       OnLost on_lost);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Clock::time_point queue_free_requests();

  void set_duration(std::int64_t duration_ns);
  void set_exposure(double exposure_us, double gain);
  [[nodiscard]] bool keeps_step() const { return sync_mode_.has_value(); }

 private:
  void configure(const RigOptions& options);
  void make_requests();
  [[nodiscard]] libcamera::ControlList first_controls(const RigOptions& options);
  [[nodiscard]] bool has(const libcamera::ControlId& control) const;
  void completed(libcamera::Request* request);
  [[nodiscard]] std::optional<RigPicture> picture_of(libcamera::Request* request) const;
  void was_disconnected();

  std::shared_ptr<libcamera::Camera> camera_;
  const Side side_;
  const std::int64_t period_ns_;
  OnPicture on_picture_;
  OnLost on_lost_;
  std::unique_ptr<libcamera::CameraConfiguration> configuration_;
  LumaLayout layout_ = LumaLayout::planar8;
  std::unique_ptr<PictureBuffers> buffers_;
  std::vector<std::unique_ptr<libcamera::Request>> requests_;
  std::optional<unsigned> sync_mode_, sync_ready_;  // ids of Raspberry Pi's controls, where there are any

  std::mutex mutex_;  // between libcamera's thread and ours
  std::vector<libcamera::Request*> free_;
  std::optional<std::int64_t> wanted_duration_ns_;
  std::optional<std::pair<double, double>> wanted_exposure_;
  double tokens_;  // requests that may be queued now
  Clock::time_point tokens_at_;
  bool running_ = false;
};

LibcameraCamera::Impl::Impl(std::shared_ptr<lc::Camera> camera, Side side, const RigOptions& options,
                            OnPicture on_picture, OnLost on_lost)
    : camera_(std::move(camera)),
      side_(side),
      period_ns_(period_of(options.rate_hz)),
      on_picture_(std::move(on_picture)),
      on_lost_(std::move(on_lost)),
      tokens_(kBuffers),
      tokens_at_(Clock::now()) {
  if (camera_->acquire() != 0)
    throw std::runtime_error("camera " + camera_->id() + " is in use by another program");
  try {
    configure(options);
    make_requests();
    camera_->requestCompleted.connect(this, &LibcameraCamera::Impl::completed);
    camera_->disconnected.connect(this, &LibcameraCamera::Impl::was_disconnected);
    const lc::ControlList controls = first_controls(options);
    if (camera_->start(&controls) != 0)
      throw std::runtime_error("camera " + camera_->id() + " does not start");
    running_ = true;
  } catch (...) {
    camera_->requestCompleted.disconnect(this);
    camera_->disconnected.disconnect(this);
    requests_.clear();
    buffers_.reset();
    camera_->release();
    throw;
  }
}

LibcameraCamera::Impl::~Impl() {
  {
    const std::scoped_lock lock(mutex_);
    running_ = false;
  }
  camera_->stop();
  camera_->requestCompleted.disconnect(this);
  camera_->disconnected.disconnect(this);
  requests_.clear();
  buffers_.reset();
  camera_->release();
}

bool LibcameraCamera::Impl::has(const lc::ControlId& control) const {
  return camera_->controls().count(control.id()) > 0;
}

void LibcameraCamera::Impl::configure(const RigOptions& options) {
  const std::string name = "camera " + camera_->id();
  configuration_ = camera_->generateConfiguration({lc::StreamRole::VideoRecording});
  if (!configuration_ || configuration_->empty()) throw std::runtime_error(name + " has no video stream");
  lc::StreamConfiguration& stream = configuration_->at(0);
  if (const auto format = best_format(stream.formats())) stream.pixelFormat = *format;
  stream.size = lc::Size(static_cast<unsigned>(options.width_px), static_cast<unsigned>(options.height_px));
  stream.bufferCount = kBuffers;
  if (configuration_->validate() == lc::CameraConfiguration::Invalid)
    throw std::runtime_error(name + " has no usable configuration");
  const auto layout = luma_layout(stream.pixelFormat.toString());
  if (!layout)
    throw std::runtime_error(name + " delivers " + stream.pixelFormat.toString() + ", which is not read");
  layout_ = *layout;
  if (stream.size.width != static_cast<unsigned>(options.width_px) ||
      stream.size.height != static_cast<unsigned>(options.height_px)) {
    throw std::runtime_error(name + " cannot deliver " + std::to_string(options.width_px) + "x" +
                             std::to_string(options.height_px) + " (nearest: " + stream.size.toString() +
                             "); the calibration says the resolution");
  }
  if (camera_->configure(configuration_.get()) != 0)
    throw std::runtime_error(name + " refuses its configuration");
  sync_mode_ = control_named(camera_->controls(), "SyncMode");
}

void LibcameraCamera::Impl::make_requests() {
  const lc::StreamConfiguration& stream = configuration_->at(0);
  buffers_ = std::make_unique<PictureBuffers>(camera_, stream);
  for (lc::FrameBuffer* buffer : buffers_->all()) {
    std::unique_ptr<lc::Request> request = camera_->createRequest();
    if (!request || request->addBuffer(stream.stream(), buffer) != 0)
      throw std::runtime_error("camera " + camera_->id() + ": no request could be made");
    free_.push_back(request.get());
    requests_.push_back(std::move(request));
  }
}

lc::ControlList LibcameraCamera::Impl::first_controls(const RigOptions& options) {
  lc::ControlList controls(camera_->controls());
  if (has(lc::controls::FrameDurationLimits)) {
    const std::array<std::int64_t, 2> limits_us{period_ns_ / 1000, period_ns_ / 1000};
    controls.set(lc::controls::FrameDurationLimits, lc::Span<const std::int64_t, 2>(limits_us));
  }
  const bool fixed = options.exposure_us > 0 || options.gain > 0;
  if (fixed && has(lc::controls::AeEnable)) controls.set(lc::controls::AeEnable, false);
  if (options.exposure_us > 0 && has(lc::controls::ExposureTime))
    controls.set(lc::controls::ExposureTime, static_cast<std::int32_t>(options.exposure_us));
  if (options.gain > 0 && has(lc::controls::AnalogueGain))
    controls.set(lc::controls::AnalogueGain, static_cast<float>(options.gain));
  if (sync_mode_) {
    constexpr std::int32_t kServer = 1, kClient = 2;
    controls.set(*sync_mode_, lc::ControlValue(side_ == Side::left ? kServer : kClient));
  }
  return controls;
}

LibcameraCamera::Clock::time_point LibcameraCamera::Impl::queue_free_requests() {
  const std::scoped_lock lock(mutex_);
  const auto now = Clock::now();
  // A little faster than the frame rate, so that a sensor never waits for a buffer.
  constexpr double kFaster = 1.02;
  const double per_ns = kFaster / static_cast<double>(period_ns_);
  tokens_ = std::min<double>(kBuffers, tokens_ + per_ns * static_cast<double>((now - tokens_at_).count()));
  tokens_at_ = now;
  while (running_ && !free_.empty() && tokens_ >= 1) {
    lc::Request* request = free_.front();
    free_.erase(free_.begin());
    if (wanted_duration_ns_ && has(lc::controls::FrameDurationLimits)) {
      const std::array<std::int64_t, 2> limits_us{*wanted_duration_ns_ / 1000, *wanted_duration_ns_ / 1000};
      request->controls().set(lc::controls::FrameDurationLimits, lc::Span<const std::int64_t, 2>(limits_us));
    }
    if (wanted_exposure_ && has(lc::controls::ExposureTime) && has(lc::controls::AnalogueGain)) {
      if (has(lc::controls::AeEnable)) request->controls().set(lc::controls::AeEnable, false);
      request->controls().set(lc::controls::ExposureTime, static_cast<std::int32_t>(wanted_exposure_->first));
      request->controls().set(lc::controls::AnalogueGain, static_cast<float>(wanted_exposure_->second));
    }
    wanted_duration_ns_.reset();
    wanted_exposure_.reset();
    if (camera_->queueRequest(request) != 0) break;  // the camera is going away
    tokens_ -= 1;
  }
  const double short_of = std::max(0.0, 1 - tokens_);
  return now + std::chrono::nanoseconds(std::llround(short_of / per_ns));
}

void LibcameraCamera::Impl::set_duration(std::int64_t duration_ns) {
  const std::scoped_lock lock(mutex_);
  wanted_duration_ns_ = duration_ns;
}

void LibcameraCamera::Impl::set_exposure(double exposure_us, double gain) {
  const std::scoped_lock lock(mutex_);
  wanted_exposure_ = {exposure_us, gain};
}

std::optional<RigPicture> LibcameraCamera::Impl::picture_of(lc::Request* request) const {
  const auto& [stream, buffer] = *request->buffers().begin();
  const lc::ControlList& metadata = request->metadata();
  const auto taken = metadata.get(lc::controls::SensorTimestamp);
  if (!taken) return std::nullopt;
  const RawPlane raw = buffers_->plane(*buffer, stream->configuration());
  RigPicture picture{side_, {*taken, grey_from_plane(raw, layout_)}, 0, 0};
  if (const auto exposure = metadata.get(lc::controls::ExposureTime)) picture.exposure_us = *exposure;
  if (const auto gain = metadata.get(lc::controls::AnalogueGain)) picture.gain = *gain;
  return picture.picture.picture.empty() ? std::nullopt : std::optional(std::move(picture));
}

void LibcameraCamera::Impl::completed(lc::Request* request) {
  if (request->status() == lc::Request::RequestCancelled) return;
  std::optional<RigPicture> picture = picture_of(request);
  request->reuse(lc::Request::ReuseBuffers);
  {
    const std::scoped_lock lock(mutex_);
    free_.push_back(request);
  }
  if (picture) on_picture_(std::move(*picture));
}

void LibcameraCamera::Impl::was_disconnected() { on_lost_("camera " + camera_->id() + " was unplugged"); }

LibcameraCamera::LibcameraCamera(std::shared_ptr<lc::Camera> camera, Side side, const RigOptions& options,
                                 OnPicture on_picture, OnLost on_lost)
    : impl_(std::make_unique<Impl>(std::move(camera), side, options, std::move(on_picture),
                                   std::move(on_lost))) {}
LibcameraCamera::~LibcameraCamera() = default;
LibcameraCamera::Clock::time_point LibcameraCamera::queue_free_requests() {
  return impl_->queue_free_requests();
}
void LibcameraCamera::set_duration(std::int64_t duration_ns) { impl_->set_duration(duration_ns); }
void LibcameraCamera::set_exposure(double exposure_us, double gain) {
  impl_->set_exposure(exposure_us, gain);
}
bool LibcameraCamera::keeps_step() const { return impl_->keeps_step(); }

}  // namespace flogmap
