// Two libcamera cameras as a rig. At most one camera manager may live in a process.
#include <libcamera/libcamera.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "camera/live/camera_rig.hpp"
#include "camera/live/libcamera_camera.hpp"
#include "camera/live/luma.hpp"

namespace flogmap {
namespace {

namespace lc = libcamera;
using Clock = std::chrono::steady_clock;

/// libcamera tells everybody what it does; errors are enough unless LIBCAMERA_LOG_LEVELS says otherwise. It
/// reads its environment when it is first used.
struct QuietLibcamera {
  QuietLibcamera() {
    constexpr int kKeepWhatIsThere = 0;
    ::setenv("LIBCAMERA_LOG_LEVELS", "*:ERROR", kKeepWhatIsThere);
  }
};

/// Starts libcamera, and ends it after everything that came from it.
class Manager {
 public:
  Manager() {
    if (manager_.start() != 0)
      throw std::runtime_error("libcamera does not start; is another program using it?");
  }
  ~Manager() { manager_.stop(); }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  [[nodiscard]] std::shared_ptr<lc::Camera> find(const std::string& id) { return manager_.get(id); }
  [[nodiscard]] std::vector<std::shared_ptr<lc::Camera>> all() const { return manager_.cameras(); }
  [[nodiscard]] std::string ids() const {
    std::string text;
    for (const auto& camera : all()) text += (text.empty() ? "" : ", ") + camera->id();
    return text.empty() ? "none" : text;
  }

 private:
  QuietLibcamera quiet_;
  lc::CameraManager manager_;
};

class LibcameraRig final : public CameraRig {
 public:
  explicit LibcameraRig(RigOptions options) : options_(std::move(options)) {
    for (const std::string& id : {options_.left_id, options_.right_id}) {
      if (!manager_.find(id))
        throw std::runtime_error("no camera '" + id + "'; there are: " + manager_.ids());
    }
    open();
  }

  std::optional<RigPicture> wait(std::chrono::milliseconds longest) override {
    const auto until = Clock::now() + longest;
    while (Clock::now() < until) {
      const auto again = std::min({queue(left_.get()), queue(right_.get()), until});
      std::unique_lock lock(mutex_);
      changed_.wait_until(lock, again, [&] { return !pictures_.empty() || stopped_ || !lost_.empty(); });
      if (stopped_) return std::nullopt;
      if (!pictures_.empty()) {
        RigPicture picture = std::move(pictures_.front());
        pictures_.pop_front();
        return picture;
      }
      if (!lost_.empty()) {
        changed_.wait_until(lock, until, [&] { return stopped_; });
        return std::nullopt;
      }
    }
    check_silence();
    return std::nullopt;
  }

  [[nodiscard]] std::string lost() const override {
    const std::scoped_lock lock(mutex_);
    return lost_;
  }

  bool reopen() override {
    left_.reset();
    right_.reset();
    if (!manager_.find(options_.left_id) || !manager_.find(options_.right_id)) return false;
    {
      const std::scoped_lock lock(mutex_);
      lost_.clear();
      pictures_.clear();
    }
    try {
      open();
      return true;
    } catch (const std::exception& error) {
      lose(error.what());
      return false;
    }
  }

  void stop() override {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  [[nodiscard]] bool keeps_step() const override { return right_ && right_->keeps_step(); }
  void set_right_duration(std::int64_t duration_ns) override {
    if (right_) right_->set_duration(duration_ns);
  }
  void set_right_exposure(double exposure_us, double gain) override {
    if (right_ && options_.exposure_us <= 0 && options_.gain <= 0) right_->set_exposure(exposure_us, gain);
  }

 private:
  static Clock::time_point queue(LibcameraCamera* camera) {
    return camera == nullptr ? Clock::time_point::max() : camera->queue_free_requests();
  }

  /// Raspberry Pi's software sync wants the client first, so the right camera is opened first.
  void open() {
    const auto on_picture = [this](RigPicture picture) { keep(std::move(picture)); };
    const auto on_lost = [this](const std::string& reason) { lose(reason); };
    right_ = std::make_unique<LibcameraCamera>(manager_.find(options_.right_id), Side::right, options_,
                                               on_picture, on_lost);
    left_ = std::make_unique<LibcameraCamera>(manager_.find(options_.left_id), Side::left, options_,
                                              on_picture, on_lost);
    heard_at_ = Clock::now();
  }

  void keep(RigPicture picture) {
    constexpr std::size_t kMost = 8;  // the reader is busy: the oldest go
    const std::scoped_lock lock(mutex_);
    if (pictures_.size() == kMost) pictures_.pop_front();
    pictures_.push_back(std::move(picture));
    heard_at_ = Clock::now();
    changed_.notify_all();
  }

  void lose(const std::string& reason) {
    const std::scoped_lock lock(mutex_);
    if (lost_.empty()) lost_ = reason;
    changed_.notify_all();
  }

  /// Some cameras vanish without a word.
  void check_silence() {
    constexpr std::chrono::seconds kSilence{3};
    Clock::time_point heard;
    {
      const std::scoped_lock lock(mutex_);
      heard = heard_at_;
    }
    if (Clock::now() - heard > kSilence) lose("the cameras have sent no picture for 3 s");
  }

  const RigOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<RigPicture> pictures_;
  std::string lost_;
  bool stopped_ = false;
  Clock::time_point heard_at_ = Clock::now();
  Manager manager_;  // outlives the cameras
  std::unique_ptr<LibcameraCamera> left_, right_;
};

std::vector<std::string> formats_of(lc::Camera& camera) {
  std::vector<std::string> formats;
  const auto configuration = camera.generateConfiguration({lc::StreamRole::VideoRecording});
  if (!configuration || configuration->empty()) return formats;
  const lc::StreamFormats& offered = configuration->at(0).formats();
  for (const lc::PixelFormat& format : offered.pixelformats()) {
    std::string text = format.toString();
    for (const lc::Size& size : offered.sizes(format)) text += ' ' + size.toString();
    if (!luma_layout(format.toString())) text += " (not read)";
    formats.push_back(std::move(text));
  }
  return formats;
}

}  // namespace

std::unique_ptr<CameraRig> open_libcamera_rig(const RigOptions& options) {
  return std::make_unique<LibcameraRig>(options);
}

std::vector<CameraDescription> list_cameras() {
  Manager manager;
  std::vector<CameraDescription> descriptions;
  for (const std::shared_ptr<lc::Camera>& camera : manager.all()) {
    const auto model = camera->properties().get(lc::properties::Model);
    descriptions.push_back({camera->id(), model ? std::string(*model) : "", formats_of(*camera)});
  }
  return descriptions;
}

}  // namespace flogmap
